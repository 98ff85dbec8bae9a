// SPDX-License-Identifier: Apache-2.0
/// Where the texels of a body appear in a picture, from what its pixels show: the inverse of an IUV image.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace bodyloom {

struct TexelPlaces {
  std::vector<float> pixels;  ///< 2 × U × U: x and y in the picture where the texel's point appears; 0: not seen
  std::vector<float> seen;    ///< U × U: 1, or 0 where it is not seen
};

/// `uv`: atlas coordinates, 2 × height × width; `parts`: DensePose's, 0 off the body. `texel_parts` (U × U): the part
/// of each texel. Between each three neighbouring pixels of one part that are near each other in the atlas (0.1),
/// places are interpolated, and continued by half a pixel at the rim; so a texel is seen where pixels around it show its
/// part. Of two places the interpolated one counts, then the upper, then the left one. Throws std::invalid_argument when sizes differ.
TexelPlaces TexelsOfPixels(std::span<const float> uv, std::span<const uint8_t> parts, int width, int height,
                           std::span<const uint8_t> texel_parts, int texture_size);

}  // namespace bodyloom
