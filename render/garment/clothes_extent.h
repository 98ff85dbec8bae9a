// SPDX-License-Identifier: Apache-2.0
/// The extent of clothes: how far they stand off the body at the silhouette of a photo, which distinguishes a skirt
/// from trousers where only the bare body of another pose is known.
///
/// A pixel of the person beside the body belongs to the nearest pixel on the body's rim (the larger of the distances
/// along x and y). A rim pixel's extent is the largest distance of those that belong to it, in diagonals of the box
/// around the torso's pixels (around all of the body's, over 3, where no torso is seen), so that it does not depend on
/// how large the person appears. Every texel takes the mean extent of the nearest rim texels
/// (render/texture/complete/texel_neighbours.h).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "render/texture/complete/texel_neighbours.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

/// U × U, 0 where the atlas is empty, and everywhere when no rim is seen. Throws std::invalid_argument for a frame
/// without labels and for sizes that do not fit.
std::vector<float> ClothesExtent(const PhotoFrame& photo, const TexelNeighbours& neighbours);

/// Where clothes that stand off so far would be in another pose: with e(q) the extent at a pixel q of the body
/// (`extent`, S × S, as looked up there) and s the diagonal above in this pose,
///   1 on the body,   clamp(½ + max_q (s e(q) − |p − q|), 0, 1) at a pixel p beside it,
/// the distance being the larger one along x and y. Exact, two sweeps. Throws std::invalid_argument for sizes that do
/// not fit.
std::vector<float> ClothedBody(const PhotoFrame& pose, std::span<const float> extent);

// Two sweeps over a picture in which every pixel is updated from its eight neighbours.

/// Calls relax(here, there) for the pixels of a width × height picture and their neighbours: from the top left with
/// those above and to the left, then from the bottom right with those below and to the right. A shortest path of king's
/// moves need not turn back, so what costs 1 a move (the larger of the distances along x and y) has reached every pixel
/// in the end. `rows_back`: every row is gone through once more the other way, which settles which of several equally
/// near pixels is heard of.
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
