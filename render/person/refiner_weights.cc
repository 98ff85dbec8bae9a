// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/person/refiner_weights.h"

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

bool RefinerWeights::IsValid(std::string* why) const {
  const auto fault = [why](const std::string& text) {
    if (why != nullptr) *why = text;
    return false;
  };
  if (!(pixels_per_metre >= 1 && pixels_per_metre <= 1e5)) {
    return fault(Concatenate("pixels_per_metre is ", pixels_per_metre, ", expected 1 to 1e5"));
  }
  if (convolutions.size() != kRefinerShapes.size()) {
    return fault(Concatenate(convolutions.size(), " convolutions, expected ", kRefinerShapes.size()));
  }
  for (size_t i = 0; i < convolutions.size(); ++i) {
    const RefinerShape& shape = kRefinerShapes[i];
    const Convolution& c = convolutions[i];
    if (c.kernel.rows() != shape.out || c.kernel.cols() != 9 * shape.in || c.bias.size() != shape.out) {
      return fault(Concatenate(shape.name, " is ", c.kernel.rows(), "x", c.kernel.cols(), " with ", c.bias.size(),
                               " biases, expected ", shape.out, "x", 9 * shape.in, " with ", shape.out));
    }
    if (!c.kernel.allFinite() || !c.bias.allFinite()) {
      return fault(Concatenate(shape.name, " has numbers that are not finite"));
    }
  }
  return true;
}

size_t RefinerWeights::num_parameters() const {
  size_t count = 0;
  for (const Convolution& c : convolutions) count += static_cast<size_t>(c.kernel.size() + c.bias.size());
  return count;
}

}  // namespace bodyloom
