// SPDX-License-Identifier: Apache-2.0
#include "render/image/parser_weights.h"

#include "geometry/base/check.h"

namespace bodyloom {

bool ParserWeights::IsValid(std::string* why) const {
  return InRange(why)("pixels_per_metre", pixels_per_metre, 1, 1e5) && network.IsValid(kParserPlanes, why);
}

bool ImageUnetWeights::IsValid(ImageUnetPlanes planes, std::string* why) const {
  const auto fault = [why](const std::string& text) {
    if (why != nullptr) *why = text;
    return false;
  };
  const auto layers = ImageUnetLayers(planes);
  if (convolutions.size() != layers.size()) {
    return fault(Concatenate(convolutions.size(), " convolutions, expected ", layers.size()));
  }
  for (size_t i = 0; i < convolutions.size(); ++i) {
    const ImageUnetLayer& layer = layers[i];
    const Convolution& c = convolutions[i];
    if (c.kernel.rows() != layer.out || c.kernel.cols() != 9 * layer.in || c.bias.size() != layer.out) {
      return fault(Concatenate(layer.name, " is ", c.kernel.rows(), "x", c.kernel.cols(), " with ", c.bias.size(),
                               " biases, expected ", layer.out, "x", 9 * layer.in, " with ", layer.out));
    }
    if (!c.kernel.allFinite() || !c.bias.allFinite()) {
      return fault(Concatenate(layer.name, " has numbers that are not finite"));
    }
  }
  return true;
}

size_t ImageUnetWeights::num_parameters() const {
  size_t count = 0;
  for (const Convolution& c : convolutions) count += static_cast<size_t>(c.kernel.size() + c.bias.size());
  return count;
}

}  // namespace bodyloom
