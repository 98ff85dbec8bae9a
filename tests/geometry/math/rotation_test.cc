// SPDX-License-Identifier: Apache-2.0
#include "geometry/math/rotation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace bodyloom::rotation_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;

std::vector<Vector3d> Axes() {
  std::vector<Vector3d> axes = {Vector3d::UnitX(), -Vector3d::UnitY(), Vector3d::UnitZ(),
                                Vector3d(1, 1, 0).normalized(), Vector3d(-1, 1e-9, 1e-5).normalized()};
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 20; ++i) axes.push_back(Vector3d{normal(random), normal(random), normal(random)}.normalized());
  return axes;
}

/// exp by its power series in long double: sum of [w]×ⁿ/n!, an independent slow twin for |w| up to about 10.
Matrix3d ExpSeries(const Vector3d& w) {
  using Matrix = Eigen::Matrix<long double, 3, 3>;
  const Matrix S = Skew(w).cast<long double>();
  Matrix term = Matrix::Identity(), sum = term;
  for (int n = 1; n < 100; ++n) {
    term = (term * S / n).eval();
    sum += term;
  }
  return sum.cast<double>();
}

/// Right Jacobian by its power series: sum of (−[w]×)ⁿ/(n+1)!.
Matrix3d RightJacobianSeries(const Vector3d& w) {
  using Matrix = Eigen::Matrix<long double, 3, 3>;
  const Matrix S = -Skew(w).cast<long double>();
  Matrix term = Matrix::Identity(), sum = term;
  for (int n = 1; n < 100; ++n) {
    term = (term * S / (n + 1)).eval();
    sum += term;
  }
  return sum.cast<double>();
}

std::vector<double> Angles() {
  std::vector<double> angles = {0, kPi - 1e-3, kPi - 1e-6, kPi - 1e-9, kPi - 1e-12};
  for (double a = 1e-12; a < kPi; a *= 3) angles.push_back(a);
  for (double a = 0.05; a < kPi; a += 0.1) angles.push_back(a);
  // Transitions between series and closed forms: |w|² = 1e-8 and 1e-2, both sides.
  for (double join : {1e-4, 1e-1}) {
    for (double side : {1 - 1e-3, 1 - 1e-12, 1.0, 1 + 1e-12, 1 + 1e-3}) angles.push_back(join * side);
  }
  return angles;
}

TEST(Rotation, SkewIsTheCrossProduct) {
  const Vector3d a(1, -2, 3), b(0.5, 4, -1);
  EXPECT_EQ((Skew(a) * b - a.cross(b)).norm(), 0);
}

TEST(Rotation, ExpAgreesWithItsPowerSeries) {
  for (const Vector3d& axis : Axes()) {
    for (double angle : Angles()) {
      const Vector3d w = angle * axis;
      EXPECT_LT((RotationFromAxisAngle(w) - ExpSeries(w)).cwiseAbs().maxCoeff(), 1e-15) << angle;
    }
    for (double angle : {kPi, 4.0, 2 * kPi, 9.0}) {
      const Vector3d w = angle * axis;
      EXPECT_LT((RotationFromAxisAngle(w) - ExpSeries(w)).cwiseAbs().maxCoeff(), 5e-15) << angle;
    }
  }
}

TEST(Rotation, ExpIsARotationForEveryFiniteVector) {
  for (const Vector3d& axis : Axes()) {
    for (double angle : {5e-324, 1e-300, 1e-160, 1e-8, 1.0, 1e8, 1e100, 1e155, 1e300, 1.7e308}) {
      const Matrix3d R = RotationFromAxisAngle(angle * axis);
      EXPECT_LT((R * R.transpose() - Matrix3d::Identity()).cwiseAbs().maxCoeff(), 5e-15) << angle;
      EXPECT_NEAR(R.determinant(), 1, 5e-15) << angle;
    }
  }
}

TEST(Rotation, RoundTripBelowPi) {
  int checked = 0;
  for (const Vector3d& axis : Axes()) {
    for (double angle : Angles()) {
      const Vector3d w = angle * axis, back = AxisAngleFromRotation(RotationFromAxisAngle(w));
      const double sign = angle > kPi - 1e-10 && back.dot(w) < 0 ? -1 : 1;  // within rounding of π the sign is free
      EXPECT_LT((sign * back - w).norm(), 4e-15 + 1e-15 * angle) << "angle " << angle << " axis " << axis.transpose();
      EXPECT_LE(back.norm(), kPi * (1 + 1e-15));
      ++checked;
    }
  }
  EXPECT_GT(checked, 1000);
}

TEST(Rotation, TinyAnglesKeepTheirRelativePrecision) {
  for (const Vector3d& axis : Axes()) {
    for (double angle = 1e-12; angle < 1e-4; angle *= 3) {
      // Entries of 1 − θ²/2 and products of components limit what the matrix itself can hold.
      const Vector3d w = angle * axis, back = AxisAngleFromRotation(RotationFromAxisAngle(w));
      EXPECT_LT((back - w).norm(), 1e-15 * angle + 2e-16 * angle * angle + 1e-32) << angle;
    }
  }
}

TEST(Rotation, ExactlyPi) {
  for (const Vector3d& axis : Axes()) {
    const Matrix3d R = 2 * axis * axis.transpose() - Matrix3d::Identity();  // symmetric to the bit
    const Vector3d w = AxisAngleFromRotation(R);
    EXPECT_NEAR(w.norm(), kPi, 1e-14);
    EXPECT_LT((RotationFromAxisAngle(w) - R).cwiseAbs().maxCoeff(), 1e-14);
    const double first = w.x() != 0 ? w.x() : w.y() != 0 ? w.y() : w.z();
    EXPECT_GT(first, 0) << w.transpose();
  }
}

TEST(Rotation, BeyondPiComesBackInsideAsTheSameRotation) {
  for (const Vector3d& axis : Axes()) {
    for (double angle : {kPi + 1e-9, kPi + 0.1, 4.0, 2 * kPi - 0.01, 2 * kPi, 7.0, 100.0}) {
      const Matrix3d R = RotationFromAxisAngle(angle * axis);
      const Vector3d w = AxisAngleFromRotation(R);
      EXPECT_LE(w.norm(), kPi * (1 + 1e-15));
      EXPECT_NEAR(w.norm(), std::abs(std::remainder(angle, 2 * kPi)), 1e-13);
      EXPECT_LT((RotationFromAxisAngle(w) - R).cwiseAbs().maxCoeff(), 1e-14) << angle;
    }
  }
}

TEST(Rotation, LogToleratesASlightlyNonOrthogonalMatrix) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const Vector3d& axis : Axes()) {
    for (double angle : {1e-3, 1.0, 3.0, kPi}) {
      Matrix3d R = RotationFromAxisAngle(angle * axis);
      for (int i = 0; i < 9; ++i) R(i / 3, i % 3) += 1e-6 * uniform(random);
      const Matrix3d back = RotationFromAxisAngle(AxisAngleFromRotation(R));
      EXPECT_LT((back - R).cwiseAbs().maxCoeff(), 1e-5);
    }
  }
}

TEST(Rotation, NanGoesInAndComesOut) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(RotationFromAxisAngle(Vector3d(nan, 0, 0)).hasNaN());
  EXPECT_TRUE(AxisAngleFromRotation(Matrix3d::Constant(nan)).hasNaN());
  EXPECT_TRUE(RotationBetweenDirections(Vector3d(nan, 0, 0), Vector3d::UnitX()).hasNaN());
  EXPECT_TRUE(NearestRotation(Matrix3d::Constant(nan)).array().isNaN().all());
  Matrix3d one_infinite = Matrix3d::Identity();
  one_infinite(1, 2) = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(NearestRotation(one_infinite).array().isNaN().all());
}

TEST(Rotation, RightJacobianAgreesWithItsPowerSeriesOnBothSidesOfTheJoin) {
  int checked = 0;
  for (const Vector3d& axis : Axes()) {
    for (double angle : Angles()) {
      const Vector3d w = angle * axis;
      EXPECT_LT((RightJacobian(w) - RightJacobianSeries(w)).cwiseAbs().maxCoeff(), 2e-15) << angle;
      ++checked;
    }
  }
  EXPECT_GT(checked, 1000);
}

TEST(Rotation, RightJacobianIsTheDerivativeOfExp) {
  const double step = 1e-5;
  int checked = 0;
  for (const Vector3d& axis : Axes()) {
    for (double angle : {0.0, 1e-6, 1e-3, 0.3, 1.0, 2.0, 3.0, kPi, 4.0, 6.0}) {
      const Vector3d w = angle * axis;
      const Matrix3d R = RotationFromAxisAngle(w), J = RightJacobian(w);
      for (int k = 0; k < 3; ++k) {
        const Vector3d plus =
            AxisAngleFromRotation(R.transpose() * RotationFromAxisAngle(w + step * Vector3d::Unit(k)));
        const Vector3d minus =
            AxisAngleFromRotation(R.transpose() * RotationFromAxisAngle(w - step * Vector3d::Unit(k)));
        EXPECT_LT(((plus - minus) / (2 * step) - J.col(k)).norm(), 1e-9) << angle;
        ++checked;
      }
    }
  }
  EXPECT_EQ(checked, 25 * 10 * 3);
}

TEST(Rotation, RightJacobianInverseInvertsUpToTwoPi) {
  for (const Vector3d& axis : Axes()) {
    for (double angle : Angles()) {
      const Vector3d w = angle * axis;
      EXPECT_LT((RightJacobian(w) * RightJacobianInverse(w) - Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-14)
          << angle;
    }
    for (double angle : {kPi, 4.0, 6.0}) {
      const Vector3d w = angle * axis;
      EXPECT_LT((RightJacobian(w) * RightJacobianInverse(w) - Matrix3d::Identity()).cwiseAbs().maxCoeff(), 2e-14)
          << angle;
    }
  }
}

TEST(Rotation, RightJacobianInverseIsTheDerivativeOfLog) {
  const double step = 1e-5;
  for (const Vector3d& axis : Axes()) {
    for (double angle : {0.0, 1e-3, 0.3, 1.0, 2.0, 3.0}) {
      const Vector3d w = angle * axis;
      const Matrix3d R = RotationFromAxisAngle(w), J = RightJacobianInverse(w);
      for (int k = 0; k < 3; ++k) {
        const Vector3d d = step * Vector3d::Unit(k);
        const Vector3d difference =
            AxisAngleFromRotation(R * RotationFromAxisAngle(d)) - AxisAngleFromRotation(R * RotationFromAxisAngle(-d));
        // The third derivative of log grows towards π.
        EXPECT_LT((difference / (2 * step) - J.col(k)).norm(), angle < 2.5 ? 1e-9 : 1e-6) << angle;
      }
    }
  }
}

TEST(Rotation, NearestRotationIsNearerThanItsNeighbours) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  int reflections = 0;
  for (int trial = 0; trial < 200; ++trial) {
    Matrix3d M;
    for (int i = 0; i < 9; ++i) M(i / 3, i % 3) = normal(random);
    reflections += M.determinant() < 0;
    const Matrix3d R = NearestRotation(M);
    EXPECT_LT((R * R.transpose() - Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(R.determinant(), 1, 1e-14);
    for (int i = 0; i < 20; ++i) {
      const Vector3d d{normal(random), normal(random), normal(random)};
      const double scale = i % 2 == 0 ? 1e-3 : 1.0;
      EXPECT_LE((R - M).norm(), (R * RotationFromAxisAngle(scale * d) - M).norm() + 1e-12);
    }
  }
  EXPECT_GT(reflections, 50);
  const Matrix3d R = RotationFromAxisAngle(Vector3d(1, 2, -0.5));
  EXPECT_LT((NearestRotation(3 * R) - R).norm(), 1e-14);
  EXPECT_NEAR(NearestRotation(Matrix3d::Zero()).determinant(), 1, 1e-14);
}

TEST(Rotation, AngleBetweenAndInterpolation) {
  const Matrix3d A = RotationFromAxisAngle(Vector3d(0.3, -1, 0.2));
  for (const Vector3d& axis : Axes()) {
    for (double angle : {0.0, 1e-9, 0.5, 3.0}) {
      const Matrix3d B = A * RotationFromAxisAngle(angle * axis);
      EXPECT_NEAR(RotationAngleBetween(A, B), angle, 1e-14);
      EXPECT_NEAR(RotationAngleBetween(A, InterpolateRotation(A, B, 0.25)), 0.25 * angle, 1e-14);
      EXPECT_LT((InterpolateRotation(A, B, 1) - B).norm(), 1e-14);
      EXPECT_LT((InterpolateRotation(A, B, 0) - A).norm(), 1e-14);
    }
  }
}

TEST(Rotation, BetweenDirections) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (const Vector3d& a : Axes()) {
    const Vector3d side = a.unitOrthogonal();
    for (double angle : {0.0, 1e-12, 1e-7, 1e-3, 1.0, 3.0, kPi - 1e-3, kPi - 1e-5}) {
      const Vector3d b = std::cos(angle) * a + std::sin(angle) * side;
      const Matrix3d R = RotationBetweenDirections(1e-3 * a, 1e3 * b);
      EXPECT_LT((R * a - b).norm(), 4e-15) << angle;
      EXPECT_NEAR(RotationAngleBetween(Matrix3d::Identity(), R), angle, 4e-15);
      EXPECT_LT((R * R.transpose() - Matrix3d::Identity()).norm(), 4e-15);
    }
    for (double from_opposite : {0.0, 1e-20, 1e-16, 1e-15, 1e-12, 1e-9, 1e-7, 1e-6}) {
      const Vector3d b = -std::cos(from_opposite) * a + std::sin(from_opposite) * side;
      const Matrix3d R = RotationBetweenDirections(a, b);
      EXPECT_LT((R * a - b).norm(), 4e-15) << from_opposite;
      EXPECT_NEAR(RotationAngleBetween(Matrix3d::Identity(), R), kPi - from_opposite, 4e-15);
    }
    // Lengths do not matter, however small or large; only zero has no direction.
    const Vector3d b{normal(random), normal(random), normal(random)};
    const Matrix3d R = RotationBetweenDirections(a, b);
    EXPECT_LT((RotationBetweenDirections(1e-200 * a, 1e-200 * b) - R).norm(), 1e-14);
    EXPECT_LT((RotationBetweenDirections(1e200 * a, 1e200 * b) - R).norm(), 1e-14);
    EXPECT_EQ(RotationBetweenDirections(a, Vector3d::Zero()), Matrix3d(Matrix3d::Identity()));
    EXPECT_EQ(RotationBetweenDirections(Vector3d::Zero(), a), Matrix3d(Matrix3d::Identity()));
  }
}

}  // namespace
}  // namespace bodyloom::rotation_test
