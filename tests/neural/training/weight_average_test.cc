// SPDX-License-Identifier: Apache-2.0
// Averages of weights against the sums that define them.
#include <gtest/gtest.h>
#include <torch/torch.h>

#include <cmath>
#include <stdexcept>

#include "neural/training/optimizers.h"

namespace bodyloom::weight_average_test {
namespace {

void SetAll(torch::nn::Module* module, double value) {
  const torch::NoGradGuard no_grad;
  for (torch::Tensor& parameter : module->parameters()) parameter.fill_(value);
}

double First(const torch::nn::Module& module) { return module.parameters()[0].flatten()[0].item<double>(); }

TEST(WeightAverage, IsTheSumWeightedByAPowerOfTheStep) {
  // A share of a quarter is γ = 2, for which the recurrence has the weights t (t + 1).
  torch::nn::Linear learner(2, 2), average(2, 2);
  learner->to(torch::kDouble);
  average->to(torch::kDouble);
  double sum = 0, weights = 0;
  for (int t = 1; t <= 400; ++t) {
    const double value = std::sin(0.3 * t) + 0.01 * t;
    sum += t * (t + 1.0) * value;
    weights += t * (t + 1.0);
    SetAll(learner.get(), value);
    AverageWeights(*learner, t, 0.25, average.get());
    ASSERT_NEAR(First(*average), sum / weights, 1e-12) << t;
  }
}

TEST(WeightAverage, IsAsOldAsItsShareSays) {
  for (const double share : {0.05, 0.1, 0.5}) {
    torch::nn::Linear learner(1, 1), average(1, 1);
    learner->to(torch::kDouble);
    average->to(torch::kDouble);
    constexpr int kSteps = 20000;
    for (int t = 1; t <= kSteps; ++t) {
      SetAll(learner.get(), t);
      AverageWeights(*learner, t, share, average.get());
    }
    EXPECT_NEAR((kSteps - First(*average)) / kSteps, share, 1e-3);
  }
}

TEST(WeightAverage, CopiesBuffers) {
  torch::nn::BatchNorm1d learner(3), average(3);
  learner->running_mean.fill_(7);
  AverageWeights(*learner, 5, 0.1, average.get());
  EXPECT_EQ(average->running_mean[0].item<float>(), 7);
}

TEST(WeightAverage, RefusesWhatDoesNotFit) {
  torch::nn::Linear learner(2, 2), same(2, 2), wider(2, 3);
  EXPECT_THROW(AverageWeights(*learner, 1, 0.1, wider.get()), std::invalid_argument);
  EXPECT_THROW(AverageWeights(*learner, 0, 0.1, same.get()), std::invalid_argument);
  EXPECT_THROW(AverageWeights(*learner, 1, 0, same.get()), std::invalid_argument);
  EXPECT_THROW(AverageWeights(*learner, 1, 0.6, same.get()), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::weight_average_test
