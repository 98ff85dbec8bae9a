// SPDX-License-Identifier: Apache-2.0
/// Adam as image-to-image networks are trained with it. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <memory>
#include <vector>

namespace bodyloom {

/// β₁ 0.5, β₂ 0.999 (Isola et al., CVPR 2017).
inline std::unique_ptr<torch::optim::Adam> MakeAdam(const torch::nn::Module& module, double rate) {
  return std::make_unique<torch::optim::Adam>(module.parameters(), torch::optim::AdamOptions(rate).betas({0.5, 0.999}));
}

/// The learning rate of all of an optimizer's parameters, for the steps that follow.
inline void SetRate(torch::optim::Adam* optimizer, double rate) {
  for (auto& group : optimizer->param_groups()) static_cast<torch::optim::AdamOptions&>(group.options()).lr(rate);
}

inline void SetRate(torch::optim::AdamW* optimizer, double rate) {
  for (auto& group : optimizer->param_groups()) static_cast<torch::optim::AdamWOptions&>(group.options()).lr(rate);
}

/// Off while a discriminator only judges: its own gradients are not computed then.
inline void RequireGradients(torch::nn::Module* module, bool on) {
  for (torch::Tensor& parameter : module->parameters()) parameter.set_requires_grad(on);
}

}  // namespace bodyloom
