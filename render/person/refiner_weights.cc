// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/person/refiner_weights.h"

#include "bodyloom/geometry/base/in_range.h"

namespace bodyloom {

bool RefinerWeights::IsValid(std::string* why) const {
  return InRange(why)("pixels_per_metre", pixels_per_metre, 1, 1e5) && network.IsValid(kRefinerPlanes, why);
}

}  // namespace bodyloom
