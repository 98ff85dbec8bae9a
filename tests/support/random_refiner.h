// SPDX-License-Identifier: Apache-2.0
/// A picture refiner that learned nothing: weights as training begins with, and a last layer that is not zero.
#pragma once

#include <cmath>
#include <random>

#include "bodyloom/render/person/refiner_weights.h"

namespace bodyloom {

/// `strength` 0: it changes nothing.
inline RefinerWeights RandomRefiner(float strength) {
  std::mt19937 random(5);
  std::normal_distribution<float> normal;
  RefinerWeights weights;
  for (const RefinerShape& shape : kRefinerShapes) {
    RefinerWeights::Convolution& convolution = weights.convolutions.emplace_back();
    convolution.kernel.resize(shape.out, 9 * shape.in);
    convolution.bias.resize(shape.out);
    const float scale = std::sqrt(2.0F / static_cast<float>(9 * shape.in)) * (shape.relu6 ? 1 : strength);
    for (Eigen::Index i = 0; i < convolution.kernel.size(); ++i) convolution.kernel.data()[i] = scale * normal(random);
    for (Eigen::Index i = 0; i < convolution.bias.size(); ++i) convolution.bias[i] = 0.1F * scale * normal(random);
  }
  weights.pixels_per_metre = 123;
  weights.recipe = "made up for a test";
  return weights;
}

}  // namespace bodyloom
