// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/people/back_of_head.h"

#include <algorithm>
#include <limits>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/neural/people/body_part_map.h"

namespace bodyloom {

HeadTexels HeadTexelsOf(std::span<const uint8_t> texel_parts, std::span<const float> texel_places) {
  const size_t texels = texel_parts.size();
  BODYLOOM_CHECK(texel_places.size() == 3 * texels, "head: ", texel_places.size(), " places of ", texels, " texels");
  HeadTexels result = {std::vector<uint8_t>(texels), std::vector<uint8_t>(texels)};
  const std::span<const float> depth = texel_places.subspan(2 * texels);
  float front = std::numeric_limits<float>::lowest(), back = std::numeric_limits<float>::max();
  for (size_t k = 0; k < texels; ++k) {
    if (LimbOf(texel_parts[k]) != kHeadLimb) continue;
    result.head[k] = 1;
    front = std::max(front, depth[k]), back = std::min(back, depth[k]);
  }
  for (size_t k = 0; k < texels; ++k) {
    result.back[k] = result.head[k] != 0 && depth[k] < 0.5 * (double(front) + back) ? 1 : 0;
  }
  return result;
}

}  // namespace bodyloom
