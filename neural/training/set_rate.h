// SPDX-License-Identifier: Apache-2.0
/// Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

namespace bodyloom {

/// The learning rate of all of an optimizer's parameters, for the steps that follow.
inline void SetRate(torch::optim::Adam* optimizer, double rate) {
  for (auto& group : optimizer->param_groups()) static_cast<torch::optim::AdamOptions&>(group.options()).lr(rate);
}

}  // namespace bodyloom
