// SPDX-License-Identifier: Apache-2.0
/// The device of the networks, one a process. Internal: includes LibTorch.
///
/// Frames become tensors on this device and networks are moved to it when they are made; what is read back comes
/// through HostValues. Everything between follows its inputs.
#pragma once

#include <torch/torch.h>

#include <vector>

namespace bodyloom {

/// The CPU until UseNeuralDevice (neural/base/runtime.h) named another one.
torch::Device NeuralDevice();
void SetNeuralDevice(torch::Device device);

inline torch::Tensor OnDevice(const torch::Tensor& tensor) { return tensor.to(NeuralDevice()); }

/// A tensor's values in C order, in the caller's memory. T: float or uint8_t.
template <typename T>
std::vector<T> HostValues(const torch::Tensor& tensor) {
  const torch::Tensor values = tensor.detach().to(torch::kCPU, c10::CppTypeToScalarType<T>::value).contiguous();
  return {values.template data_ptr<T>(), values.template data_ptr<T>() + values.numel()};
}

/// As torch::randn, drawn on the CPU wherever the tensor goes: a run that is resumed draws the same.
torch::Tensor RandnLike(const torch::Tensor& tensor);

}  // namespace bodyloom
