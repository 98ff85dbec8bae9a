// SPDX-License-Identifier: Apache-2.0
/// Weights that bring losses to the scale of a reference loss, determined once and then constant.
///
/// During the first `warmup` steps the losses are measured; then λ_i = mean(reference)/mean(loss_i), clamped to [1e-3,
/// 1e2], for the rest of the run (0 for a loss that was 0 throughout). Yoon et al., CVPR 2021, choose theirs
/// "empirically … that all the losses have comparable scale" without stating them. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <span>
#include <vector>

namespace bodyloom {

class LossBalance {
 public:
  LossBalance(int num_losses, int warmup);

  /// Adds a step of the warm-up; does nothing after it.
  void Measure(double reference, std::span<const double> losses);
  [[nodiscard]] bool IsSet() const;
  /// 0 until the weights are set.
  [[nodiscard]] double Weight(int loss) const;

  /// State for a checkpoint, as doubles: steps measured, sums (the reference's first), weights.
  [[nodiscard]] torch::Tensor* state() { return &state_; }

 private:
  int num_losses_, warmup_;
  torch::Tensor state_;
};

}  // namespace bodyloom
