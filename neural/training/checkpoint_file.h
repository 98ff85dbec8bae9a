// SPDX-License-Identifier: Apache-2.0
/// The bytes of a checkpoint (layout: checkpoint.h): named tensors to a file and back. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <string>
#include <utility>
#include <vector>

namespace bodyloom {

using NamedTensors = std::vector<std::pair<std::string, torch::Tensor>>;

/// Tensors of any device; types float, double, half, bfloat16, int64, int32, int16, int8, uint8, bool.
void WriteTensorFile(const std::string& path, const NamedTensors& tensors);

/// In the file's order, on the CPU. The file's size, every claim and the checksum are checked before anything is
/// returned. Throws std::runtime_error, one line that begins with the path.
NamedTensors ReadTensorFile(const std::string& path);

}  // namespace bodyloom
