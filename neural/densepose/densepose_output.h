// SPDX-License-Identifier: Apache-2.0
/// Converts both forms of DensePose's output to one set of checked tensors. Internal: includes LibTorch.
#pragma once

#include <torch/script.h>

#include <optional>
#include <string>

namespace bodyloom {

enum class DensePoseForm { kTuple, kDict };

/// Form of a `forward` by its declared return type: five tensors, or a dictionary of tensors by text; none otherwise.
std::optional<DensePoseForm> DensePoseFormOf(const c10::Type& returned);

/// Output for n people; floats in C order on the CPU.
struct DensePoseOutput {
  torch::Tensor boxes;       ///< n×4
  torch::Tensor scores;      ///< n; ones in the tuple form
  torch::Tensor coarse;      ///< n×C×h×w, C >= 2
  torch::Tensor fine, u, v;  ///< n×25×h×w
};

/// Checks and converts `value`, which must have the form's type. Throws std::runtime_error "path: …" for a number of
/// outputs, a key or a shape other than the above.
DensePoseOutput CheckedDensePoseOutput(const c10::IValue& value, DensePoseForm form, const std::string& path);

}  // namespace bodyloom
