// SPDX-License-Identifier: Apache-2.0
/// The device of the networks, one per process. Internal: includes LibTorch.
///
/// Tensors of frames are created on this device and networks moved to it on construction; results are read by
/// HostValues. All operations in between run on the device of their inputs.
#pragma once

#include <torch/torch.h>

#include <vector>

namespace bodyloom {

/// The device in use: the CPU until UseNeuralDevice (neural/base/runtime.h) selects another.
torch::Device NeuralDevice();
void SetNeuralDevice(torch::Device device);

inline torch::Tensor OnDevice(const torch::Tensor& tensor) { return tensor.to(NeuralDevice()); }

/// Copies a tensor's values to host memory in C order. T: float or uint8_t.
template <typename T>
std::vector<T> HostValues(const torch::Tensor& tensor) {
  const torch::Tensor values = tensor.detach().to(torch::kCPU, c10::CppTypeToScalarType<T>::value).contiguous();
  return {values.template data_ptr<T>(), values.template data_ptr<T>() + values.numel()};
}

/// As torch::randn_like, but drawn on the CPU for any device, so that a resumed run draws the same numbers.
torch::Tensor RandnLike(const torch::Tensor& tensor);

}  // namespace bodyloom
