// SPDX-License-Identifier: Apache-2.0
/// Writes and reads named tensors in the file format of checkpoints (layout: checkpoint.h). Internal: includes
/// LibTorch.
#pragma once

#include <torch/torch.h>

#include <string>
#include <utility>
#include <vector>

namespace bodyloom {

using NamedTensors = std::vector<std::pair<std::string, torch::Tensor>>;

/// Tensors of any device; types float, double, half, bfloat16, int64, int32, int16, int8, uint8, bool.
void WriteTensorFile(const std::string& path, const NamedTensors& tensors);

/// Reads tensors in the file's order, on the CPU, after checking the file's size, all declared sizes and the checksum.
/// Throws std::runtime_error, one line that begins with the path.
NamedTensors ReadTensorFile(const std::string& path);

}  // namespace bodyloom
