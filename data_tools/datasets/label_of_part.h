// SPDX-License-Identifier: Apache-2.0
/// Clothing class of a body part, for photos without labels of the clothes.
#pragma once

#include <array>
#include <cstdint>

#include "bodyloom/data_tools/datasets/single_person_dataset.h"
#include "bodyloom/geometry/observations.h"
#include "bodyloom/render/image.h"

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

/// A picture of `width` × `height` of these classes, in the first channel, as CutLabels takes labels. Unknown parts
/// (255) inside the person's silhouette count as top.
inline Image LabelPicture(const LabelImage& parts, int width, int height) {
  Image picture(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) picture.pixel(x, y)[0] = static_cast<uint8_t>(LabelOfPart(parts.At(x, y)));
  }
  return picture;
}

}  // namespace bodyloom
