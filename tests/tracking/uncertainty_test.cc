// SPDX-License-Identifier: Apache-2.0
#include "tracking/uncertainty.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

namespace bodyloom {
namespace {

using Eigen::MatrixXd;

TEST(Uncertainty, DiagonalOfTheInverseEqualsTheDenseInverse) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const std::vector<int> sizes = {4, 6, 3, 5};
  const int n = 18;
  MatrixXd H = MatrixXd::Zero(n, n);
  std::vector<MatrixXd> diagonal, upper;
  int at = 0;
  for (size_t i = 0; i < sizes.size(); ++i) {
    const int s = sizes[i];
    const MatrixXd A = MatrixXd::NullaryExpr(s, s, [&]() { return normal(random); });
    H.block(at, at, s, s) = A * A.transpose() + 20 * MatrixXd::Identity(s, s);
    diagonal.push_back(H.block(at, at, s, s));
    if (i + 1 < sizes.size()) {
      upper.push_back(MatrixXd::NullaryExpr(s, sizes[i + 1], [&]() { return normal(random); }));
      H.block(at, at + s, s, sizes[i + 1]) = upper.back();
      H.block(at + s, at, sizes[i + 1], s) = upper.back().transpose();
    }
    at += s;
  }
  const MatrixXd dense = H.inverse();
  const std::vector<MatrixXd> inverse = BlockTridiagonalInverseDiagonal(diagonal, upper);
  ASSERT_EQ(inverse.size(), sizes.size());
  at = 0;
  for (size_t i = 0; i < sizes.size(); ++i) {
    EXPECT_LT((inverse[i] - dense.block(at, at, sizes[i], sizes[i])).norm(), 1e-12) << i;
    at += sizes[i];
  }
  diagonal[2] = -diagonal[2];
  EXPECT_TRUE(BlockTridiagonalInverseDiagonal(diagonal, upper).empty());
}

}  // namespace
}  // namespace bodyloom
