// SPDX-License-Identifier: Apache-2.0
/// Untrained image U-Nets with initial weights and a nonzero last layer.
#pragma once

#include <cmath>
#include <random>

#include "render/image/parser_weights.h"

namespace bodyloom {

inline ImageUnetWeights RandomImageUnet(ImageUnetPlanes planes, float strength) {
  std::mt19937 random(5);
  std::normal_distribution<float> normal;
  ImageUnetWeights weights;
  for (const ImageUnetLayer& layer : ImageUnetLayers(planes)) {
    ImageUnetWeights::Convolution& convolution = weights.convolutions.emplace_back();
    convolution.kernel.resize(layer.out, 9 * layer.in);
    convolution.bias.resize(layer.out);
    const float scale = std::sqrt(2.0F / static_cast<float>(9 * layer.in)) * (layer.relu6 ? 1 : strength);
    for (Eigen::Index i = 0; i < convolution.kernel.size(); ++i) convolution.kernel.data()[i] = scale * normal(random);
    for (Eigen::Index i = 0; i < convolution.bias.size(); ++i) convolution.bias[i] = 0.1F * scale * normal(random);
  }
  return weights;
}

inline ParserWeights RandomParser(float strength) {
  return {RandomImageUnet(kParserPlanes, strength), 123, "made up for a test"};
}

}  // namespace bodyloom
