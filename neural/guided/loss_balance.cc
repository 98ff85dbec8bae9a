// SPDX-License-Identifier: Apache-2.0
#include "neural/guided/loss_balance.h"

#include <algorithm>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr double kMinimum = 1e-3, kMaximum = 1e2;

}  // namespace

LossBalance::LossBalance(int num_losses, int warmup)
    : num_losses_(num_losses), warmup_(warmup), state_(torch::zeros({2 + 2 * num_losses}, torch::kDouble)) {
  BODYLOOM_CHECK(num_losses >= 0 && warmup >= 1, "loss balance: ", num_losses, " losses, ", warmup,
                 " steps to warm up, expected 0 and 1 or more");
}

bool LossBalance::IsSet() const { return state_.data_ptr<double>()[0] >= warmup_; }

double LossBalance::Weight(int loss) const { return state_.data_ptr<double>()[2 + num_losses_ + loss]; }

void LossBalance::Measure(double reference, std::span<const double> losses) {
  BODYLOOM_CHECK(static_cast<int>(losses.size()) == num_losses_, "loss balance: ", losses.size(), " losses, expected ",
                 num_losses_);
  if (IsSet()) return;
  double* state = state_.data_ptr<double>();
  state[0] += 1;
  state[1] += reference;
  for (int i = 0; i < num_losses_; ++i) state[2 + i] += losses[i];
  if (!IsSet()) return;
  for (int i = 0; i < num_losses_; ++i) {
    const double sum = state[2 + i];
    state[2 + num_losses_ + i] = sum > 0 ? std::clamp(state[1] / sum, kMinimum, kMaximum) : 0;
  }
}

}  // namespace bodyloom
