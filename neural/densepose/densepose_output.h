// SPDX-License-Identifier: Apache-2.0
/// The two forms of DensePose's answer as one set of checked tensors. Internal: includes LibTorch.
#pragma once

#include <torch/script.h>

#include <optional>
#include <string>

namespace bodyloom {

enum class DensePoseForm { kTuple, kDict };

/// By the declared type of what a `forward` returns: five tensors, or a dictionary of tensors by text; none otherwise.
std::optional<DensePoseForm> DensePoseFormOf(const c10::Type& returned);

/// Of n people; floats in C order on the CPU.
struct DensePoseOutput {
  torch::Tensor boxes;       ///< n×4
  torch::Tensor scores;      ///< n; ones in the tuple form
  torch::Tensor coarse;      ///< n×C×h×w, C >= 2
  torch::Tensor fine, u, v;  ///< n×25×h×w
};

/// Throws std::runtime_error "path: …" for a number of outputs, a key or a shape that is not as above; `value` must
/// have the form's type.
DensePoseOutput CheckedDensePoseOutput(const c10::IValue& value, DensePoseForm form, const std::string& path);

}  // namespace bodyloom
