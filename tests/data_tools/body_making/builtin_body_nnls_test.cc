// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/body_making/nonnegative_least_squares.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace bodyloom {
namespace {

/// Karush–Kuhn–Tucker: x ≥ 0, gradient g = AᵀA x − Aᵀb ≥ 0 where x = 0 and zero elsewhere.
TEST(NonnegativeLeastSquares, OptimalityOfRandomProblems) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  int clamped = 0, free = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const int n = 1 + trial % 20, m = n + 5;
    const Eigen::MatrixXd A = Eigen::MatrixXd::NullaryExpr(m, n, [&] { return normal(random); });
    const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(m, [&] { return normal(random); });
    const Eigen::VectorXd x = SolveNonnegative(A.transpose() * A, A.transpose() * b);
    const Eigen::VectorXd gradient = A.transpose() * (A * x - b);
    for (int i = 0; i < n; ++i) {
      EXPECT_GE(x[i], 0);
      EXPECT_GE(gradient[i], -1e-8);
      EXPECT_LT(x[i] * std::abs(gradient[i]), 1e-8);
      ++(x[i] == 0 ? clamped : free);
    }
  }
  EXPECT_GT(clamped, 500);
  EXPECT_GT(free, 500);
}

TEST(NonnegativeLeastSquares, ExactWhenTheFreeSolutionIsPositive) {
  const Eigen::Matrix2d AtA = (Eigen::Matrix2d() << 2, 1, 1, 3).finished();
  const Eigen::Vector2d x(0.7, 0.2);
  EXPECT_LT((SolveNonnegative(AtA, AtA * x) - x).norm(), 1e-14);
  EXPECT_EQ(SolveNonnegative(AtA, Eigen::Vector2d(-1, -2)), Eigen::Vector2d(0, 0));
}

TEST(NonnegativeLeastSquares, RefusesBadInput) {
  EXPECT_THROW(SolveNonnegative(Eigen::MatrixXd::Identity(3, 3), Eigen::VectorXd::Ones(2)), std::invalid_argument);
  EXPECT_THROW(
      SolveNonnegative(Eigen::MatrixXd::Identity(2, 2), Eigen::Vector2d(1, std::numeric_limits<double>::quiet_NaN())),
      std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom
