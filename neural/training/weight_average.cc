// SPDX-License-Identifier: Apache-2.0
#include "neural/training/weight_average.h"

#include <algorithm>

#include "geometry/check.h"

namespace bodyloom {

using torch::Tensor;

void AverageWeights(const torch::nn::Module& learner, int64_t n, double horizon, torch::nn::Module* average) {
  BODYLOOM_CHECK(n >= 1 && horizon >= 1, "weight average: update ", n, " with a horizon of ", horizon,
                 ", expected at least 1 each");
  const torch::NoGradGuard no_grad;
  const double share = 1 / std::min(static_cast<double>(n), horizon);
  const auto each = [](const auto& from, const auto& to, const auto& move) {
    bool same = from.size() == to.size();
    for (const auto& item : from) {
      const Tensor* target = same ? to.find(item.key()) : nullptr;
      same = target != nullptr && target->sizes() == item.value().sizes();
      if (!same) break;
      move(item.value(), *target);
    }
    BODYLOOM_CHECK(same, "weight average: two networks that differ");
  };
  each(learner.named_parameters(), average->named_parameters(),
       [&](const Tensor& w, Tensor mean) { share == 1 ? mean.copy_(w) : mean.lerp_(w, share); });
  each(learner.named_buffers(), average->named_buffers(), [](const Tensor& w, Tensor mean) { mean.copy_(w); });
}

}  // namespace bodyloom
