// SPDX-License-Identifier: Apache-2.0
/// Checks of a ceres::Problem. A header by itself: few tests need Ceres.
#pragma once

#include <ceres/problem.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <vector>

namespace bodyloom {

/// Cost to 1e-10 and gradient to 1e-9, relative, at the values of the parameters.
inline void ExpectCostAndGradient(ceres::Problem* problem, double expected, const Eigen::VectorXd& expected_gradient) {
  double cost = 0;
  std::vector<double> gradient;
  ASSERT_TRUE(problem->Evaluate({}, &cost, nullptr, &gradient, nullptr));
  EXPECT_NEAR(cost, expected, 1e-10 * expected);
  ASSERT_EQ(gradient.size(), static_cast<size_t>(expected_gradient.size()));
  const Eigen::Map<const Eigen::VectorXd> found(gradient.data(), expected_gradient.size());
  EXPECT_LE((found - expected_gradient).norm(), 1e-9 * expected_gradient.norm());
}

}  // namespace bodyloom
