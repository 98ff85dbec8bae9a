// SPDX-License-Identifier: Apache-2.0
/// Weights of a network as plain arrays, as provided to neural/ by readers of weight files.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace bodyloom {

struct NamedArray {
  std::vector<int64_t> shape;
  std::vector<float> values;  ///< in C order; as many as the product of the shape
};

/// By the name in the file, such as "features.0.weight".
using NamedWeights = std::map<std::string, NamedArray>;

/// Weights and their file, for messages.
struct WeightsFrom {
  NamedWeights weights;
  std::string source;
  [[nodiscard]] bool empty() const { return weights.empty(); }
};

}  // namespace bodyloom
