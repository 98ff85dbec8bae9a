// SPDX-License-Identifier: Apache-2.0
/// Random weights with the shapes of published networks, like users' files.
#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <string>

#include "neural/networks/vgg.h"

namespace bodyloom {

/// Weights of all layers up to `tap`.
inline NamedWeights TrunkWeights(FeatureTrunk trunk, int tap) {
  FeatureNetworkOptions options;
  options.trunk = trunk;
  options.taps = {tap};
  options.random_features_seed = 5;
  return ExportWeights(*FeatureNetwork(options));
}

inline NamedWeights AlexNetWeights() { return TrunkWeights(FeatureTrunk::kAlexNet, 11); }

/// LPIPS' channel weights on AlexNet.
inline NamedWeights HeadWeights() {
  NamedWeights heads;
  std::mt19937 random(3);
  const std::array<int64_t, 5> channels = {64, 192, 384, 256, 256};
  for (int k = 0; k < 5; ++k) {
    NamedArray& array = heads["lin" + std::to_string(k) + ".model.1.weight"];
    array.shape = {1, channels[k], 1, 1};
    for (int c = 0; c < channels[k]; ++c) array.values.push_back(static_cast<float>(random() % 1000) / 1000.0F);
  }
  return heads;
}

}  // namespace bodyloom
