// SPDX-License-Identifier: Apache-2.0
/// The picture refiner (render/person/refiner_weights.h) as a module that learns. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include "bodyloom/neural/networks/picture_unet_module.h"
#include "bodyloom/render/person/refiner_weights.h"

namespace bodyloom {

struct RefinerModuleImpl : torch::nn::Module {
  /// An untrained refiner changes nothing.
  explicit RefinerModuleImpl(bool moves_outline);
  /// B×PersonPlane::kCount×H×W → B×4×H×W, what ChangedPerson() takes: alpha near the outline (KeepNearOutline()), or
  /// zeros where the outline stays. Throws std::invalid_argument as PictureUnetModule.
  torch::Tensor forward(const torch::Tensor& planes);

  bool moves_outline;
  PictureUnetModule network;
};
TORCH_MODULE(RefinerModule);

/// The person as the refiner changes it (ChangedPerson()), B×4×H×W.
torch::Tensor ChangedPerson(const torch::Tensor& planes, const torch::Tensor& change);

}  // namespace bodyloom
