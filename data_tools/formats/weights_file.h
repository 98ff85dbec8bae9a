// SPDX-License-Identifier: Apache-2.0
/// Network weights by name, whatever file they come from.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "bodyloom/data_tools/formats/ndarray.h"

namespace bodyloom {

struct WeightsFile {
  std::map<std::string, NdArray> tensors;
  std::vector<std::string> ignored;             ///< entries that are no tensors, by name, sorted
  std::map<std::string, std::string> metadata;  ///< safetensors: __metadata__
};

struct ReadWeightsOptions {
  bool widen_halves = false;           ///< float16 and bfloat16 arrive as float32 (exact)
  size_t max_bytes = size_t{1} << 32;  ///< of the file, and of all tensors together
};

/// The tensors of a .safetensors file, or of a .pth / .pt file in either of PyTorch's formats; the contents tell which.
/// Throws std::runtime_error as safetensors.h and torch_weights.h say.
WeightsFile ReadWeights(const std::string& path, const ReadWeightsOptions& options = {});
WeightsFile WeightsFromBytes(const std::string& bytes, const std::string& where,
                             const ReadWeightsOptions& options = {});

}  // namespace bodyloom
