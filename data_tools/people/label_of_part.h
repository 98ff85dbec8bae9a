// SPDX-License-Identifier: Apache-2.0
/// What class of clothing a part of the body is taken for where nobody labelled the clothes.
#pragma once

#include <array>
#include <cstdint>

#include "data_tools/people/person_set.h"

namespace bodyloom {

/// DensePose's parts 0 (background) to 24: torso and upper arms top, legs bottom, head face, lower arms and hands skin,
/// feet shoes. Others count as top.
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
