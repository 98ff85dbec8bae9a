// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/descriptors/seen_texels.h"

#include <algorithm>
#include <cstring>

#include "bodyloom/render/texel_sight.h"

namespace bodyloom::describe_internal {

SeenTexels FindSeenTexels(const UvTexelTable& table, const BodyModel& body, const MatrixX3d& vertices,
                          const Camera& camera, VisibilityBuffer* buffer) {
  buffer->Render(vertices, body.data().faces, camera);
  const std::vector<TexelSight> sights =
      SeeTexels(table, body, vertices, camera, *buffer, {.min_cosine = 0, .whole_footprint = false});
  SeenTexels result;
  std::vector<char>& seen = result.seen;
  seen.assign(size_t(table.width) * table.height, 0);
  int num_seen = 0;
  for (size_t i = 0; i < sights.size(); ++i) {
    seen[table.pixel[i]] = sights[i].cosine > 0;
    num_seen += sights[i].cosine > 0;
  }
  result.share = static_cast<double>(num_seen) / table.num_inside;
  // A gutter texel goes with the texels of its chart beside it.
  for (size_t i = 0; i < table.size(); ++i) {
    if (!table.in_gutter[i]) continue;
    const int x = table.pixel[i] % table.width, y = table.pixel[i] / table.width;
    for (int q = std::max(0, y - 1); q <= std::min(table.height - 1, y + 1); ++q) {
      for (int p = std::max(0, x - 1); p <= std::min(table.width - 1, x + 1); ++p) {
        const int beside = q * table.width + p;
        if (seen[beside] == 1 && table.chart_at[beside] == table.chart_at[table.pixel[i]]) {
          seen[table.pixel[i]] = 2;  // 2: does not spread
        }
      }
    }
  }
  return result;
}

std::vector<char> KeepSeen(const UvTexelTable& table, const std::vector<char>& seen,
                           std::span<const std::span<const char>> maps, size_t item_size) {
  const size_t num_pixels = size_t(table.width) * table.height, map_bytes = 3 * num_pixels * item_size;
  std::vector<char> masked(map_bytes * maps.size(), 0);
  char* out = masked.data();
  for (const std::span<const char>& map : maps) {
    for (int c = 0; c < 3; ++c) {
      const size_t plane = size_t(c) * num_pixels * item_size;
      for (const int pixel : table.pixel) {
        if (!seen[pixel]) continue;
        const size_t at = plane + size_t(pixel) * item_size;
        std::memcpy(out + at, map.data() + at, item_size);
      }
    }
    out += map_bytes;
  }
  return masked;
}

}  // namespace bodyloom::describe_internal
