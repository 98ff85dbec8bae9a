// SPDX-License-Identifier: Apache-2.0
#include "geometry/math/rotation.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d Skew(const Vector3d& w) {
  Matrix3d S;
  S << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return S;
}

Matrix3d RotationFromAxisAngle(const Vector3d& w) {
  const double angle2 = w.squaredNorm();
  if (angle2 < 1e-8) {
    const Matrix3d S = Skew(w);
    return Matrix3d::Identity() + (1 - angle2 / 6) * S + (0.5 - angle2 / 24) * S * S;
  }
  // By the unit axis rather than by w, whose square overflows for angles beyond 1e154.
  const double angle = angle2 < 1e300 ? std::sqrt(angle2) : w.stableNorm();
  const Matrix3d S = Skew(w / angle);
  const double half_sine = std::sin(angle / 2);
  return Matrix3d::Identity() + std::sin(angle) * S + 2 * half_sine * half_sine * S * S;
}

Vector3d AxisAngleFromRotation(const Matrix3d& R) {
  Eigen::Quaterniond q(R);  // picks the largest component, stable at π
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  if (sine < 1e-10) return 2 * q.vec() / std::max(q.w(), 0.5);
  const double angle = 2 * std::atan2(sine, q.w());
  Vector3d axis = q.vec() / sine;
  if (q.w() == 0) {
    for (int i = 0; i < 3; ++i) {
      if (axis[i] != 0) {
        if (axis[i] < 0) axis = -axis;
        break;
      }
    }
  }
  return angle * axis;
}

Matrix3d RightJacobian(const Vector3d& w) {
  const double angle2 = w.squaredNorm();
  double b, c;  // (1 − cos θ)/θ² and (θ − sin θ)/θ³; both lose digits to cancellation well above the smallest angles
  if (angle2 < 1e-2) {
    b = 1.0 / 2 - angle2 * (1.0 / 24 - angle2 * (1.0 / 720 - angle2 * (1.0 / 40320 - angle2 / 3628800)));
    c = 1.0 / 6 - angle2 * (1.0 / 120 - angle2 * (1.0 / 5040 - angle2 * (1.0 / 362880 - angle2 / 39916800)));
  } else {
    const double angle = std::sqrt(angle2), half_sine = std::sin(angle / 2);
    b = 2 * half_sine * half_sine / angle2;
    c = (angle - std::sin(angle)) / (angle2 * angle);
  }
  const Matrix3d S = Skew(w);
  return Matrix3d::Identity() - b * S + c * S * S;
}

Matrix3d RightJacobianInverse(const Vector3d& w) {
  const double angle2 = w.squaredNorm();
  double c;  // 1/θ² − (1 + cos θ)/(2 θ sin θ), written with half angles so that θ = π is regular
  if (angle2 < 1e-2) {
    c = 1.0 / 12 + angle2 * (1.0 / 720 + angle2 * (1.0 / 30240 + angle2 * (1.0 / 1209600 + angle2 / 47900160)));
  } else {
    const double angle = std::sqrt(angle2);
    c = 1 / angle2 - std::cos(angle / 2) / (2 * angle * std::sin(angle / 2));
  }
  const Matrix3d S = Skew(w);
  return Matrix3d::Identity() + 0.5 * S + c * S * S;
}

Eigen::Matrix<double, 9, 3> EntriesByIncrement(const Matrix3d& R) {
  Eigen::Matrix<double, 9, 3> result;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> derivative = R * Skew(Vector3d::Unit(k));
    result.col(k) = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(derivative.data());
  }
  return result;
}

Matrix3d NearestRotation(const Matrix3d& M) {
  if (!M.allFinite()) return Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN());  // the SVD would not say
  const Eigen::JacobiSVD<Matrix3d> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vector3d d(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1.0 : 1.0);
  return svd.matrixU() * d.asDiagonal() * svd.matrixV().transpose();
}

double RotationAngleBetween(const Matrix3d& A, const Matrix3d& B) {
  return AxisAngleFromRotation(A.transpose() * B).norm();
}

Matrix3d InterpolateRotation(const Matrix3d& A, const Matrix3d& B, double t) {
  return A * RotationFromAxisAngle(t * AxisAngleFromRotation(A.transpose() * B));
}

Matrix3d RotationBetweenDirections(const Vector3d& from, const Vector3d& to) {
  if (from.isZero(0) || to.isZero(0)) return Matrix3d::Identity();
  const Vector3d a = from.stableNormalized(), b = to.stableNormalized();
  const double angle = 2 * std::atan2((a - b).norm(), (a + b).norm());  // exact near 0 and near π
  // Near 0 and π the cross product is mostly rounding; what matters is that the axis is perpendicular to a.
  Vector3d axis = a.cross(b);
  axis -= a.dot(axis) * a;
  const double sine = axis.norm();
  return RotationFromAxisAngle(angle * (sine > 0 ? Vector3d(axis / sine) : a.unitOrthogonal()));
}

}  // namespace bodyloom
