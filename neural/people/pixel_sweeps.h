// SPDX-License-Identifier: Apache-2.0
/// Two sweeps over a picture in which every pixel is updated from its eight neighbours.
#pragma once

#include <cstddef>

namespace bodyloom {

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
