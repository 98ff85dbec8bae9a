// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/score/scored_renderer.h"

#include <algorithm>

namespace bodyloom {

CoherentMaps MapsOf(std::span<const PhotoFrame> photos, const PhotoSource& people) {
  CoherentMaps maps = EmptyMaps(people.texture_size, people.texel_parts);
  for (size_t k = 0; k < photos.size(); ++k) {
    FillEmptyTexels(photos[k], OwnPicture(photos[k]), static_cast<uint8_t>(k + 1), {}, &maps);
  }
  return maps;
}

double ShareSeen(const CoherentMaps& maps, size_t used) {
  double filled = 0, atlas = 0;
  for (size_t i = 0; i < maps.from.size(); ++i) {
    atlas += maps.texel_parts[i] != 0 ? 1 : 0;
    filled += maps.from[i] != 0 && maps.from[i] <= used ? 1 : 0;
  }
  return filled / std::max(1.0, atlas);
}

std::vector<uint8_t> SomebodyOf(std::span<const float> alpha) {
  std::vector<uint8_t> labels;
  for (const float a : alpha) labels.push_back(a >= 0.5F ? 1 : 0);
  return labels;
}

}  // namespace bodyloom
