// SPDX-License-Identifier: Apache-2.0
/// Clothing class of a body part, for photos without labels of the clothes.
#pragma once

#include <cstdint>

#include "bodyloom/geometry/observations.h"
#include "bodyloom/geometry/person_label.h"
#include "bodyloom/render/image.h"

namespace bodyloom {

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
