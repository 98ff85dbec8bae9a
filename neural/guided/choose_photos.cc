// SPDX-License-Identifier: Apache-2.0
#include "neural/guided/choose_photos.h"

#include <algorithm>

#include "neural/guided/coherent_maps.h"

namespace bodyloom {

std::vector<int> ChoosePhotos(const PhotoSource& people, int person, int count) {
  const int frames = people.num_frames.at(person);
  std::vector<std::vector<uint8_t>> shown(frames);  // by texel
  std::vector<int> faces(frames);
  for (int f = 0; f < frames; ++f) {
    PhotoFrame frame;
    people.fill(person, f, &frame);
    CoherentMaps maps = EmptyMaps(frame.texture_size, people.texel_parts);
    FillEmptyTexels(frame, OwnImage(frame), 1, {}, &maps);
    shown[f] = std::move(maps.from);
    faces[f] = static_cast<int>(std::count(frame.labels.begin(), frame.labels.end(), uint8_t{3}));
  }
  std::vector<int> chosen;
  std::vector<uint8_t> seen(people.texel_parts.size());
  while (static_cast<int>(chosen.size()) < std::min(count, frames)) {
    int best = -1;
    int64_t maximum = -1;
    for (int f = 0; f < frames; ++f) {
      if (std::find(chosen.begin(), chosen.end(), f) != chosen.end()) continue;
      int64_t gain = faces[f];
      if (!chosen.empty()) {
        gain = 0;
        for (size_t i = 0; i < seen.size(); ++i) gain += shown[f][i] != 0 && seen[i] == 0 ? 1 : 0;
      }
      if (gain > maximum) {
        maximum = gain;
        best = f;
      }
    }
    chosen.push_back(best);
    for (size_t i = 0; i < seen.size(); ++i) seen[i] |= shown[best][i];
  }
  return chosen;
}

}  // namespace bodyloom
