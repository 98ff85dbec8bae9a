// SPDX-License-Identifier: Apache-2.0
/// The offset of clothes: their distance from the body at the silhouette of a photo. It distinguishes a skirt from
/// trousers when only the bare body is known in another pose.
///
/// A pixel of the person beside the body belongs to the nearest pixel on the body's rim (the larger of the distances
/// along x and y). A rim pixel's offset is the largest distance of its pixels, in units of the diagonal of the box
/// around the torso's pixels (a third of that around the body's, if no torso is seen), so that it is independent of the
/// person's size in the image. Every texel takes the mean offset of the nearest rim texels
/// (render/texture/complete/texel_neighbours.h).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "render/texture/complete/texel_neighbours.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

/// Extent of each texel, U × U; 0 where the atlas is empty, and everywhere when no rim is seen. Throws
/// std::invalid_argument for a frame without labels and for sizes that do not fit.
std::vector<float> ClothesOffsetMap(const PhotoFrame& photo, const TexelNeighbours& neighbours);

/// Predicts the clothed silhouette in another pose: with e(q) the offset at a pixel q of the body (`clothes_offset`
/// sampled there, S × S) and s the diagonal above in this pose,
///   1 on the body,   clamp(½ + max_q (s e(q) − |p − q|), 0, 1) at a pixel p beside it,
/// with the Chebyshev distance. Exact, in two sweeps. Throws std::invalid_argument for sizes that do not fit.
std::vector<float> ClothedBody(const PhotoFrame& pose, std::span<const float> clothes_offset);

// Distance-transform sweeps over an image: every pixel is updated from its eight neighbours.

/// Calls relax(here, there) for the pixels of a width × height image and their neighbours: from the top left with those
/// above and to the left, then from the bottom right with those below and to the right. Chebyshev distances (cost 1 per
/// move) are exact after the two sweeps. `rows_back`: each row is also swept in the opposite direction, which decides
/// among equally near pixels.
template <class Relax>
void SweepNeighbours(int width, int height, bool rows_back, const Relax& relax) {
  const auto hear = [&](int x, int y, int dx, int dy) {
    if (x + dx < 0 || x + dx >= width || y + dy < 0 || y + dy >= height) return;
    relax(size_t(y) * width + x, size_t(y + dy) * width + (x + dx));
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (const int dx : {-1, 0, 1}) hear(x, y, dx, -1);
      hear(x, y, -1, 0);
    }
    for (int x = width - 1; rows_back && x >= 0; --x) hear(x, y, 1, 0);
  }
  for (int y = height - 1; y >= 0; --y) {
    for (int x = width - 1; x >= 0; --x) {
      for (const int dx : {-1, 0, 1}) hear(x, y, dx, 1);
      hear(x, y, 1, 0);
    }
    for (int x = 0; rows_back && x < width; ++x) hear(x, y, -1, 0);
  }
}

}  // namespace bodyloom
