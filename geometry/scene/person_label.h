// SPDX-License-Identifier: Apache-2.0
/// Labels of the pixels of a person: background, clothes, face, hair, skin, shoes.
#pragma once

#include <array>
#include <cstdint>

namespace bodyloom {

/// Label of a pixel; the names, in this order, are kPersonLabelNames.
enum class PersonLabel : uint8_t { kBackground, kTop, kBottom, kFace, kHair, kSkin, kShoes };
inline constexpr int kNumPersonLabels = 7;
inline constexpr std::array<const char*, kNumPersonLabels> kPersonLabelNames = {"background", "top",  "bottom", "face",
                                                                                "hair",       "skin", "shoes"};

/// Maps DensePose's parts 0 (background) to 24: torso and upper arms to top, legs to bottom, head to face, lower arms
/// and hands to skin, feet to shoes, others to top.
inline PersonLabel LabelOfPart(int part) {
  constexpr PersonLabel kTop = PersonLabel::kTop, kBottom = PersonLabel::kBottom, kSkin = PersonLabel::kSkin;
  constexpr std::array<PersonLabel, 25> kLabels = {PersonLabel::kBackground,
                                                   kTop,
                                                   kTop,
                                                   kSkin,
                                                   kSkin,
                                                   PersonLabel::kShoes,
                                                   PersonLabel::kShoes,
                                                   kBottom,
                                                   kBottom,
                                                   kBottom,
                                                   kBottom,
                                                   kBottom,
                                                   kBottom,
                                                   kBottom,
                                                   kBottom,
                                                   kTop,
                                                   kTop,
                                                   kTop,
                                                   kTop,
                                                   kSkin,
                                                   kSkin,
                                                   kSkin,
                                                   kSkin,
                                                   PersonLabel::kFace,
                                                   PersonLabel::kFace};
  return part >= 0 && part < static_cast<int>(kLabels.size()) ? kLabels[part] : kTop;
}

}  // namespace bodyloom
