// SPDX-License-Identifier: Apache-2.0
#include "tracking/solvers/residuals/acceleration_cost.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <random>

#include "geometry/math/rotation.h"
#include "tests/tracking/jet_twin.h"
#include "tracking/solvers/residuals/ceres_functions.h"

namespace bodyloom::acceleration_cost_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using twin::Jet;
using RowMatrix3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr double kDt0 = 0.02, kDt1 = 0.05, kSigma = 30;

/// Residual with Jets: frame `frame` is turned by the increment along `axis`.
twin::Vector3<Jet> Twin(const Vector3d w[3], int frame, int axis) {
  twin::Matrix3<Jet> R[3];
  for (int i = 0; i < 3; ++i) {
    twin::Vector3<Jet> delta(Jet(0.0), Jet(0.0), Jet(0.0));
    if (i == frame) delta[axis] = Jet(0.0, 0);
    R[i] = RotationFromAxisAngle(w[i]).cast<Jet>() * twin::Exp(delta);
  }
  const twin::Vector3<Jet> v0 = twin::Log<Jet>(R[0].transpose() * R[1]) / Jet(kDt0);
  const twin::Vector3<Jet> v1 = twin::Log<Jet>(R[1].transpose() * R[2]) / Jet(kDt1);
  return (v1 - v0) / Jet((kDt0 + kDt1) / 2 * kSigma);
}

TEST(RotationAcceleration, MatchesAutomaticDerivatives) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  const RotationAccelerationCost cost(kDt0, kDt1, kSigma);
  int checked = 0;
  for (double size : {0.0, 1e-5, 0.1, 1.0, 3.0}) {
    Vector3d w[3];
    w[0] = Vector3d{normal(random), normal(random), normal(random)};
    for (int i = 1; i < 3; ++i) {
      Vector3d step{normal(random), normal(random), normal(random)};
      step = size * step.normalized();
      w[i] = AxisAngleFromRotation(RotationFromAxisAngle(w[i - 1]) * RotationFromAxisAngle(step));
    }
    const double* parameters[3] = {w[0].data(), w[1].data(), w[2].data()};
    Vector3d r, r_only;
    RowMatrix3d J[3];
    double* jacobians[3] = {J[0].data(), J[1].data(), J[2].data()};
    ASSERT_TRUE(cost.Evaluate(parameters, r.data(), jacobians));
    ASSERT_TRUE(cost.Evaluate(parameters, r_only.data(), nullptr));
    EXPECT_EQ(r, r_only);
    for (int frame = 0; frame < 3; ++frame) {
      for (int axis = 0; axis < 3; ++axis) {
        const twin::Vector3<Jet> expected = Twin(w, frame, axis);
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(r[c], expected[c].a, 1e-9 * std::max(1.0, r.norm()));
          EXPECT_NEAR(J[frame](c, axis), expected[c].v[0], 1e-9 * J[frame].norm()) << "size " << size;
          ++checked;
        }
      }
    }
  }
  EXPECT_EQ(checked, 5 * 27);
}

TEST(RotationAcceleration, IsZeroForConstantAngularVelocityAtAnyFrameRate) {
  const Vector3d velocity(0.5, -2.0, 1.0);  // rad/s
  Vector3d w[3];
  const double times[3] = {0, kDt0, kDt0 + kDt1};
  for (int i = 0; i < 3; ++i) {
    w[i] = AxisAngleFromRotation(RotationFromAxisAngle({2, 1, 0}) * RotationFromAxisAngle(times[i] * velocity));
  }
  const double* parameters[3] = {w[0].data(), w[1].data(), w[2].data()};
  Vector3d r;
  ASSERT_TRUE(RotationAccelerationCost(kDt0, kDt1, kSigma).Evaluate(parameters, r.data(), nullptr));
  EXPECT_LT(r.norm(), 1e-10);
}

TEST(VectorAcceleration, IsTheSecondDifferenceAndItsDerivative) {
  const double sigma[3] = {2, 3, 4};
  const VectorAccelerationCost cost(kDt0, kDt1, sigma);
  const Vector3d acceleration(6, -3, 8), velocity(1, 2, 3), start(5, 5, 5);
  Vector3d x[3];
  const double times[3] = {0, kDt0, kDt0 + kDt1};
  for (int i = 0; i < 3; ++i) x[i] = start + times[i] * velocity + 0.5 * times[i] * times[i] * acceleration;
  const double* parameters[3] = {x[0].data(), x[1].data(), x[2].data()};
  Vector3d r;
  RowMatrix3d J[3];
  double* jacobians[3] = {J[0].data(), J[1].data(), J[2].data()};
  ASSERT_TRUE(cost.Evaluate(parameters, r.data(), jacobians));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(r[c], acceleration[c] / sigma[c], 1e-9);
  // Linear in the parameters: J x = r, and a shift of all three changes nothing.
  EXPECT_LT((J[0] * x[0] + J[1] * x[1] + J[2] * x[2] - r).norm(), 1e-9 * J[1].norm());
  EXPECT_LT((J[0] + J[1] + J[2]).norm(), 1e-9 * J[1].norm());
}

TEST(RotationManifold, PlusAndMinusAreInverse) {
  const RotationManifold manifold;
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 50; ++i) {
    Vector3d x{normal(random), normal(random), normal(random)}, delta{normal(random), normal(random), normal(random)};
    x *= i % 5 == 0 ? 3.1415926 / x.norm() : 1;  // at π as well
    delta *= 0.5;
    Vector3d y, back;
    manifold.Plus(x.data(), delta.data(), y.data());
    manifold.Minus(y.data(), x.data(), back.data());
    EXPECT_LT((back - delta).norm(), 1e-7);
    EXPECT_LT((RotationFromAxisAngle(y) - RotationFromAxisAngle(x) * RotationFromAxisAngle(delta)).norm(), 1e-7);
  }
}

TEST(LinearCost, ResidualAndJacobian) {
  RowMatrixXd A(2, 3);
  A << 1, 2, 3, 4, 5, 6;
  const LinearCost cost(A, Eigen::Vector2d(7, 8));
  const Vector3d x(1, -1, 2);
  const double* parameters[1] = {x.data()};
  Eigen::Vector2d r;
  RowMatrixXd J(2, 3);
  double* jacobians[1] = {J.data()};
  ASSERT_TRUE(cost.Evaluate(parameters, r.data(), jacobians));
  EXPECT_EQ(r, A * x + Eigen::Vector2d(7, 8));
  EXPECT_EQ(J, A);
}

}  // namespace
}  // namespace bodyloom::acceleration_cost_test
