// SPDX-License-Identifier: Apache-2.0
#include "render/image/person_layers.h"

#include <algorithm>

namespace bodyloom {
namespace {

int RoundUp(int size) { return (size + kLayersMultiple - 1) / kLayersMultiple * kLayersMultiple; }

}  // namespace

PersonLayers BoxAround(int width, int height, std::span<const uint8_t> coverage, int reach) {
  int x0 = width, x1 = -1, y0 = height, y1 = -1;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (coverage[static_cast<size_t>(y) * width + x] == 0) continue;
      x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
    }
  }
  PersonLayers layers;
  if (x1 < 0) return layers;
  const int across = x1 - x0 + 1, down = y1 - y0 + 1;
  layers.width = RoundUp(across + 2 * reach);
  layers.height = RoundUp(down + 2 * reach);
  layers.x = x0 - (layers.width - across) / 2, layers.y = y0 - (layers.height - down) / 2;
  return layers;
}

}  // namespace bodyloom
