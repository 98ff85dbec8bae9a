// SPDX-License-Identifier: Apache-2.0
#include "neural/training/optimizers.h"

#include <gtest/gtest.h>

#include <cmath>

namespace bodyloom::muon_test {
namespace {

using torch::Tensor;

TEST(Muon, OrthogonalFactorsHaveSingularValuesNearOne) {
  torch::manual_seed(3);
  for (const auto& [m, n] : {std::pair<int, int>{24, 24}, {24, 72}, {72, 24}, {1, 8}}) {
    // Singular values from 1 down to 0.02.
    const int rank = std::min(m, n);
    Tensor u = std::get<0>(torch::linalg_qr(torch::randn({m, rank}, torch::kDouble)));
    Tensor v = std::get<0>(torch::linalg_qr(torch::randn({n, rank}, torch::kDouble)));
    const Tensor s = torch::logspace(0, -1.7, rank, 10, torch::kDouble);
    const Tensor matrix = torch::matmul(u * s, v.t());
    const Tensor result = ApproximateOrthogonalFactor(matrix);
    ASSERT_EQ(result.sizes(), matrix.sizes());
    const Tensor values = torch::linalg_svdvals(result);
    EXPECT_GT(values.min().item<double>(), 0.3) << m << "x" << n;
    EXPECT_LT(values.max().item<double>(), 1.3) << m << "x" << n;
    // The same singular vectors: Uᵀ X V is diagonal.
    const Tensor core = torch::matmul(torch::matmul(u.t(), result), v);
    EXPECT_LT((core - torch::diag(torch::diag(core))).abs().max().item<double>(), 1e-9) << m << "x" << n;
  }
  EXPECT_EQ(ApproximateOrthogonalFactor(torch::zeros({4, 6})).abs().max().item<float>(), 0);
}

TEST(Muon, StepsAsItsFormulaSays) {
  torch::manual_seed(4);
  Tensor weight = torch::randn({6, 4, 3}, torch::kDouble).requires_grad_(true);
  Muon muon({weight}, {.momentum = 0.9, .weight_decay = 0.1});
  Tensor expected = weight.detach().clone(), momentum = torch::zeros_like(expected);
  for (int step = 0; step < 3; ++step) {
    const Tensor gradient = torch::randn({6, 4, 3}, torch::kDouble);
    weight.mutable_grad() = gradient.clone();
    muon.Step(0.01);
    momentum = 0.9 * momentum + gradient;
    const Tensor turn = ApproximateOrthogonalFactor((gradient + 0.9 * momentum).reshape({6, 12})).reshape({6, 4, 3});
    expected = (1 - 0.01 * 0.1) * expected - 0.01 * 0.2 * std::sqrt(12.0) * turn;
    EXPECT_LT((weight.detach() - expected).abs().max().item<double>(), 1e-12) << step;
  }
}

TEST(Muon, GoesOnFromWhatItSaved) {
  torch::manual_seed(5);
  const Tensor start = torch::randn({4, 5});
  const auto step = [](Muon* muon, Tensor* weight, int seed) {
    torch::manual_seed(seed);
    weight->mutable_grad() = torch::randn({4, 5});
    muon->Step(0.02);
  };
  Tensor a = start.clone().requires_grad_(true), b = start.clone().requires_grad_(true);
  Muon whole({a}, {}), first({b}, {}), second({b}, {});
  step(&whole, &a, 1);
  step(&whole, &a, 2);
  step(&first, &b, 1);
  for (size_t i = 0; i < first.momenta().size(); ++i) second.momenta()[i] = first.momenta()[i].clone();
  step(&second, &b, 2);
  EXPECT_TRUE(torch::equal(a, b));
}

TEST(Muon, RefusesVectors) { EXPECT_THROW(Muon({torch::zeros({4})}, {}), std::invalid_argument); }

}  // namespace
}  // namespace bodyloom::muon_test
