// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/shots.h"

#include <cstddef>

namespace bodyloom {

std::vector<int> ShotOfFrames(const std::vector<char>& cut_before) {
  std::vector<int> shot(cut_before.size(), 0);
  for (size_t t = 1; t < shot.size(); ++t) shot[t] = shot[t - 1] + (cut_before[t] != 0 ? 1 : 0);
  return shot;
}

}  // namespace bodyloom
