// SPDX-License-Identifier: Apache-2.0
/// Copies weights from plain arrays into a module, and back. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <functional>
#include <string>
#include <vector>

#include "neural/networks/named_weights.h"

namespace bodyloom {

/// The name in the file of the module's parameter (or buffer), such as "net.slice1.0.weight" for "features.0.weight".
using WeightName = std::function<std::string(const std::string& parameter)>;

struct LoadWeightsOptions {
  WeightName name_in_file;     ///< default: the same name
  bool allow_missing = false;  ///< leave parameters missing in the file unchanged
};

struct LoadWeightsReport {
  std::vector<std::string> missing;  ///< of the module, under the file's names
  std::vector<std::string> unused;   ///< of the file
};

/// Copies every parameter and buffer of `module` from `weights`. On failure the module is unchanged. Throws
/// std::runtime_error "source: tensor NAME: what was found, expected what" for a shape that differs, a value that is
/// not finite, a number of values other than the shape's product, and (unless allowed) missing tensors.
LoadWeightsReport LoadWeights(const NamedWeights& weights, const std::string& source, torch::nn::Module* module,
                              const LoadWeightsOptions& options = {});

/// Every parameter and buffer as float32, under the module's own names.
NamedWeights ExportWeights(const torch::nn::Module& module);

}  // namespace bodyloom
