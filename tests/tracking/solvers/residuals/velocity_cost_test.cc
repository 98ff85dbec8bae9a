// SPDX-License-Identifier: Apache-2.0
#include "tracking/solvers/residuals/acceleration_cost.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <random>
#include <stdexcept>

#include "geometry/math/rotation.h"
#include "tests/tracking/jet_twin.h"

namespace bodyloom::velocity_cost_test {
namespace {

using Eigen::Vector3d;
using twin::Jet;
using RowMatrix3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr double kDt = 0.04, kSigma = 0.7;

/// Residual with Jets: frame `frame` is turned by the increment along `axis`.
twin::Vector3<Jet> VelocityTwin(const Vector3d w[2], int frame, int axis) {
  twin::Matrix3<Jet> R[2];
  for (int i = 0; i < 2; ++i) {
    twin::Vector3<Jet> delta(Jet(0.0), Jet(0.0), Jet(0.0));
    if (i == frame) delta[axis] = Jet(0.0, 0);
    R[i] = RotationFromAxisAngle(w[i]).cast<Jet>() * twin::Exp(delta);
  }
  return twin::Log<Jet>(R[0].transpose() * R[1]) / Jet(kDt * kSigma);
}

TEST(RotationVelocity, MatchesAutomaticDerivatives) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  const RotationVelocityCost cost(kDt, kSigma);
  for (double size : {0.0, 1e-5, 0.1, 1.0, 3.0}) {
    const Vector3d first{normal(random), normal(random), normal(random)};
    const Vector3d step = size * Vector3d{normal(random), normal(random), normal(random)}.normalized();
    const Vector3d w[2] = {first, AxisAngleFromRotation(RotationFromAxisAngle(first) * RotationFromAxisAngle(step))};
    const double* parameters[2] = {w[0].data(), w[1].data()};
    Vector3d r, r_only;
    RowMatrix3d J[2];
    double* jacobians[2] = {J[0].data(), J[1].data()};
    ASSERT_TRUE(cost.Evaluate(parameters, r.data(), jacobians));
    ASSERT_TRUE(cost.Evaluate(parameters, r_only.data(), nullptr));
    EXPECT_EQ(r, r_only);
    EXPECT_LT((r - step / (kDt * kSigma)).norm(), 1e-6);
    for (int frame = 0; frame < 2; ++frame) {
      for (int axis = 0; axis < 3; ++axis) {
        const twin::Vector3<Jet> expected = VelocityTwin(w, frame, axis);
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(J[frame](c, axis), expected[c].v[0], 1e-9 * J[frame].norm())
              << size << " " << frame << " " << axis << " " << c;
        }
      }
    }
  }
}

TEST(VectorVelocity, IsTheDifferenceAndItsDerivative) {
  const double sigma[3] = {1, 2, 4}, x0[3] = {1, 2, 3}, x1[3] = {2, 4, 7};
  const VectorVelocityCost cost(0.5, sigma);
  const double* parameters[2] = {x0, x1};
  Vector3d r;
  RowMatrix3d J[2];
  double* jacobians[2] = {J[0].data(), J[1].data()};
  ASSERT_TRUE(cost.Evaluate(parameters, r.data(), jacobians));
  EXPECT_EQ(r, Vector3d(2, 2, 2));
  EXPECT_EQ(J[1], RowMatrix3d(Vector3d(2, 1, 0.5).asDiagonal()));
  EXPECT_EQ(J[0], -J[1]);
}

TEST(VelocityCosts, RefuseWhatHasNoMeaning) {
  const double sigma[3] = {1, 0, 1};
  EXPECT_THROW(RotationVelocityCost(0, 1), std::invalid_argument);
  EXPECT_THROW(RotationVelocityCost(1, -1), std::invalid_argument);
  EXPECT_THROW(VectorVelocityCost(1, sigma), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::velocity_cost_test
