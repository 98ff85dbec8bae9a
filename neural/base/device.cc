// SPDX-License-Identifier: Apache-2.0
#include "neural/base/device.h"

namespace bodyloom {
namespace {

torch::Device& Current() {
  static torch::Device device(torch::kCPU);
  return device;
}

}  // namespace

torch::Device NeuralDevice() { return Current(); }
void SetNeuralDevice(torch::Device device) { Current() = device; }

torch::Tensor RandnLike(const torch::Tensor& tensor) { return torch::randn(tensor.sizes()).to(tensor.options()); }

}  // namespace bodyloom
