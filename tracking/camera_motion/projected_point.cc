// SPDX-License-Identifier: Apache-2.0
#include "tracking/camera_motion/projected_point.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "geometry/base/percentile.h"
#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix23d = Eigen::Matrix<double, 2, 3>;

constexpr double kLeastDepth = 1e-6;  ///< z of points in front, as a share of their distance
constexpr double kWideKernel = 24, kNarrowKernel = 2;
constexpr int kStepsOfPlace = 30, kStepsOfPoint = 8, kFewestGood = 6;

bool IsInFront(const Vector3d& in_camera) { return in_camera.z() > kLeastDepth * in_camera.norm(); }

/// Derivative of the pixel by the point in camera axes.
Matrix23d PixelByPoint(const Vector3d& p, double focal) {
  Matrix23d by_point;
  by_point << 1, 0, -p.x() / p.z(), 0, 1, -p.y() / p.z();
  return by_point * (focal / p.z());
}

double CauchyWeight(double r2, double scale) { return 1 / (1 + r2 / (scale * scale)); }

}  // namespace

bool ProjectedPointCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const Eigen::Map<const Vector3d> w(parameters[0]), centre(parameters[1]), point(parameters[2]);
  const double focal = std::exp(parameters[3][0]);
  const Matrix3d R = RotationFromAxisAngle(w);
  const Vector3d offset = point - centre, in_camera = R * offset;
  if (!IsInFront(in_camera)) return false;
  const Vector2d projected = focal * in_camera.head<2>() / in_camera.z();
  Eigen::Map<Vector2d>(residuals, 2) = (projected - pixel_) / sigma_px_;
  if (jacobians == nullptr) return true;
  using RowMajor23 = Eigen::Matrix<double, 2, 3, Eigen::RowMajor>;
  const Matrix23d by_point = PixelByPoint(in_camera, focal) * R / sigma_px_;
  if (jacobians[0] != nullptr) {
    Eigen::Map<RowMajor23> by_w(jacobians[0]);
    by_w = -by_point * Skew(offset) * RightJacobian(w);
  }
  if (jacobians[1] != nullptr) Eigen::Map<RowMajor23>(jacobians[1], 2, 3) = -by_point;
  if (jacobians[2] != nullptr) Eigen::Map<RowMajor23>(jacobians[2], 2, 3) = by_point;
  if (jacobians[3] != nullptr) Eigen::Map<Vector2d>(jacobians[3], 2) = projected / sigma_px_;
  return true;
}

double ProjectionDistance(const CameraPlace& camera, double focal, const PointInPicture& seen) {
  const Vector3d in_camera = RotationFromAxisAngle(camera.w) * (seen.point - camera.centre);
  if (!IsInFront(in_camera)) return std::numeric_limits<double>::infinity();
  return (focal * in_camera.head<2>() / in_camera.z() - seen.pixel).norm();
}

double EpipolarDistance2(const Matrix3d& F, const Vector2d& from, const Vector2d& to) {
  const Vector3d line_to = F * from.homogeneous(), line_from = F.transpose() * to.homogeneous();
  const double e = to.homogeneous().dot(line_to);
  return e * e / std::max(1e-30, line_to.head<2>().squaredNorm() + line_from.head<2>().squaredNorm());
}

std::optional<FittedPlace> FitCameraPlace(std::span<const PointInPicture> seen, double focal, double sigma_px,
                                          const CameraPlace& start) {
  if (seen.size() < size_t(kFewestGood)) return std::nullopt;
  std::vector<double> at_start;
  for (const PointInPicture& point : seen) {
    at_start.push_back(std::min(1e6, ProjectionDistance(start, focal, point) / sigma_px));
  }
  const double widest = std::max(kWideKernel, Percentile(at_start, 50));
  FittedPlace fit;
  Matrix3d R = RotationFromAxisAngle(start.w);
  Vector3d centre = start.centre;
  Matrix6d normal = Matrix6d::Zero();
  for (int step = 0; step < kStepsOfPlace; ++step) {
    // The last third of the steps has the narrow kernel.
    const double narrowed = std::min(1.0, 1.5 * step / kStepsOfPlace);
    const double scale = widest * std::pow(kNarrowKernel / widest, narrowed);
    normal.setZero();
    Vector6d gradient = Vector6d::Zero();
    for (const PointInPicture& point : seen) {
      const Vector3d offset = point.point - centre, in_camera = R * offset;
      if (!IsInFront(in_camera)) continue;
      const Vector2d r = (focal * in_camera.head<2>() / in_camera.z() - point.pixel) / sigma_px;
      const Matrix23d by_point = PixelByPoint(in_camera, focal) * R / sigma_px;
      Eigen::Matrix<double, 2, 6> J;
      J << -by_point * Skew(offset), -by_point;
      const double weight = CauchyWeight(r.squaredNorm(), scale);
      normal += weight * J.transpose() * J;
      gradient += weight * J.transpose() * r;
    }
    Matrix6d damped = normal;
    damped.diagonal() *= 1 + 1e-6;
    const Eigen::LDLT<Matrix6d> factor(damped);
    if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > 0)) return std::nullopt;
    const Vector6d increment = -factor.solve(gradient);
    if (!increment.allFinite() || increment.head<3>().norm() > 1) return std::nullopt;
    R = R * RotationFromAxisAngle(increment.head<3>());
    centre += increment.tail<3>();
  }
  fit.place = {AxisAngleFromRotation(NearestRotation(R)), centre};
  double squares = 0;
  for (const PointInPicture& point : seen) {
    const double r = ProjectionDistance(fit.place, focal, point) / sigma_px;
    if (!(r < 3)) continue;
    ++fit.num_good;
    squares += r * r;
  }
  if (fit.num_good < kFewestGood) return std::nullopt;
  const double variance = std::max(0.05, squares / (2.0 * fit.num_good));
  fit.covariance = variance * normal.inverse();
  return fit;
}

std::optional<FittedPoint> FitPoint(std::span<const PixelOfCamera> seen, double focal, double sigma_px, double good_px,
                                    double farthest) {
  if (seen.size() < 2) return std::nullopt;
  std::vector<Matrix3d> rotations;
  std::vector<Vector3d> rays;
  Matrix3d sum = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  for (const PixelOfCamera& one : seen) {
    rotations.push_back(RotationFromAxisAngle(one.camera.w));
    rays.push_back((rotations.back().transpose() * (one.pixel / focal).homogeneous()).normalized());
    const Matrix3d across = Matrix3d::Identity() - rays.back() * rays.back().transpose();
    sum += across;
    right += across * one.camera.centre;
  }
  FittedPoint fit;
  double least_cosine = 1;
  for (const Vector3d& ray : rays) {
    for (const Vector3d& other : rays) least_cosine = std::min(least_cosine, ray.dot(other));
  }
  fit.angle = std::acos(std::clamp(least_cosine, -1.0, 1.0));
  const Vector3d& first = seen.front().camera.centre;
  sum += 1e-12 * Matrix3d::Identity();
  fit.point = sum.ldlt().solve(right);
  const auto keep_in_reach = [&] {
    const double along = (fit.point - first).dot(rays.front());
    if (!fit.point.allFinite() || !(along > 0) || along > farthest) fit.point = first + farthest * rays.front();
  };
  keep_in_reach();
  for (int step = 0; step < kStepsOfPoint; ++step) {
    Matrix3d normal = Matrix3d::Zero();
    Vector3d gradient = Vector3d::Zero();
    for (size_t i = 0; i < seen.size(); ++i) {
      const Vector3d in_camera = rotations[i] * (fit.point - seen[i].camera.centre);
      if (!IsInFront(in_camera)) return std::nullopt;
      const Vector2d r = (focal * in_camera.head<2>() / in_camera.z() - seen[i].pixel) / sigma_px;
      const Matrix23d J = PixelByPoint(in_camera, focal) * rotations[i] / sigma_px;
      const double weight = CauchyWeight(r.squaredNorm(), step < kStepsOfPoint / 2 ? 10 : kNarrowKernel);
      normal += weight * J.transpose() * J;
      gradient += weight * J.transpose() * r;
    }
    // Along the ray of a far point nothing is seen.
    normal += 1e-9 * normal.trace() * Matrix3d::Identity();
    fit.point -= normal.ldlt().solve(gradient);
    keep_in_reach();
  }
  size_t good = 0;
  for (const PixelOfCamera& one : seen) {
    good += ProjectionDistance(one.camera, focal, {fit.point, one.pixel}) < good_px ? 1 : 0;
  }
  if (good < 2 || 3 * good < 2 * seen.size()) return std::nullopt;
  return fit;
}

}  // namespace bodyloom
