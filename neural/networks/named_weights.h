// SPDX-License-Identifier: Apache-2.0
/// Weights of a network as plain arrays: what readers of weight files hand to neural/.
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

/// By the name that the file gives, such as "features.0.weight".
using NamedWeights = std::map<std::string, NamedArray>;

/// Weights and the file they are from, which messages name.
struct WeightsFrom {
  NamedWeights weights;
  std::string source;
  [[nodiscard]] bool empty() const { return weights.empty(); }
};

}  // namespace bodyloom
