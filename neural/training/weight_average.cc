// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/training/weight_average.h"

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

using torch::Tensor;

void AverageWeights(const torch::nn::Module& learner, int64_t n, double share, torch::nn::Module* average) {
  BODYLOOM_CHECK(n >= 1 && share > 0 && share <= 0.5, "weight average: step ", n, " with a share of ", share,
                 ", expected a step of at least 1 and a share in (0, 0.5]");
  const torch::NoGradGuard no_grad;
  const double gamma = 1 / share - 2;
  const double weight = (gamma + 1) / (static_cast<double>(n) + gamma);
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
       [&](const Tensor& w, const Tensor& mean) { n == 1 ? mean.copy_(w) : mean.lerp_(w, weight); });
  each(learner.named_buffers(), average->named_buffers(), [](const Tensor& w, const Tensor& mean) { mean.copy_(w); });
}

}  // namespace bodyloom
