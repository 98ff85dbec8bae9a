// SPDX-License-Identifier: Apache-2.0
#include "geometry/scene/camera.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/check.h"

namespace bodyloom {

using Eigen::Matrix2d;
using Eigen::Vector2d;

namespace {

/// Numerator or denominator of the radial factor with its derivative by s = r².
struct Cubic {
  double value, slope;
  Cubic(double k1, double k2, double k3, double s)
      : value(1 + s * (k1 + s * (k2 + s * k3))), slope(k1 + s * (2 * k2 + 3 * s * k3)) {}
};

/// Returns true if r → r·f(r²) increases from the axis all the way to r². Beyond a fold it may increase again, outside
/// the field of view.
bool RadialMapRises(const std::array<double, 8>& d, double r2) {
  const auto rises_at = [&d](double s) {
    const Cubic n(d[0], d[1], d[4], s), m(d[5], d[6], d[7], s);
    return m.value > 0 && n.value * m.value + 2 * s * (n.slope * m.value - n.value * m.slope) > 0;
  };
  if (!rises_at(r2)) return false;
  // Usual lenses: coefficients so small that no sign can change on the way.
  const Cubic n(std::abs(d[0]), std::abs(d[1]), std::abs(d[4]), r2),
      m(std::abs(d[5]), std::abs(d[6]), std::abs(d[7]), r2);
  if (m.value < 2 && (2 - n.value) * (2 - m.value) > 2 * r2 * (n.slope * m.value + n.value * m.slope)) return true;
  constexpr int kSamples = 32;
  for (int i = 1; i < kSamples; ++i) {
    if (!rises_at(r2 * i / kSamples)) return false;
  }
  return true;
}

/// OpenCV's rational distortion of (a, b) with its 2×2 Jacobian; false outside the lens' field of view.
bool Distort(const std::array<double, 8>& d, const Vector2d& ab, Vector2d* uv, Matrix2d* J) {
  const double a = ab.x(), b = ab.y(), r2 = a * a + b * b;
  if (!RadialMapRises(d, r2)) return false;
  const Cubic numerator(d[0], d[1], d[4], r2), denominator(d[5], d[6], d[7], r2);
  const double f = numerator.value / denominator.value;
  const double df = (numerator.slope - f * denominator.slope) / denominator.value;  // d f / d r²
  *uv = {a * f + 2 * d[2] * a * b + d[3] * (r2 + 2 * a * a), b * f + d[2] * (r2 + 2 * b * b) + 2 * d[3] * a * b};
  (*J)(0, 0) = f + 2 * a * a * df + 2 * d[2] * b + 6 * d[3] * a;
  (*J)(0, 1) = 2 * a * b * df + 2 * d[2] * a + 2 * d[3] * b;
  (*J)(1, 0) = 2 * a * b * df + 2 * d[2] * a + 2 * d[3] * b;
  (*J)(1, 1) = f + 2 * b * b * df + 6 * d[2] * b + 2 * d[3] * a;
  return true;
}

}  // namespace

std::string ToString(CameraModel model) { return model == CameraModel::kPinhole ? "pinhole" : "weak"; }

CameraModel CameraModelFromString(const std::string& name) {
  if (name == "pinhole") return CameraModel::kPinhole;
  if (name == "weak") return CameraModel::kWeakPerspective;
  BODYLOOM_CHECK(false, "camera model '", name, "' is unknown; expected 'pinhole' or 'weak'");
  return CameraModel::kPinhole;
}

bool Camera::HasDistortion() const {
  return std::any_of(distortion.begin(), distortion.end(), [](double k) { return k != 0; });
}

Eigen::Matrix3d Camera::K() const {
  Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
  if (model == CameraModel::kPinhole) {
    K << fx, 0, cx, 0, fy, cy, 0, 0, 1;
  } else {
    K << scale, 0, cx, 0, scale, cy, 0, 0, 1;
  }
  return K;
}

bool Camera::Project(const Eigen::Vector3d& X, Vector2d* pixel, Matrix2x3d* J) const {
  pixel->setZero();
  if (J != nullptr) J->setZero();
  if (!X.allFinite()) return false;
  if (model == CameraModel::kWeakPerspective) {
    *pixel = {scale * (X.x() + tx) + cx, scale * (X.y() + ty) + cy};
    if (J != nullptr) *J << scale, 0, 0, 0, scale, 0;
    return true;
  }
  if (!(X.z() > kMinDepth)) return false;
  const double iz = 1 / X.z();
  const Vector2d ab(X.x() * iz, X.y() * iz);
  Vector2d uv = ab;
  Matrix2d D = Matrix2d::Identity();
  if (HasDistortion() && !Distort(distortion, ab, &uv, &D)) return false;
  *pixel = {fx * uv.x() + cx, fy * uv.y() + cy};
  if (J != nullptr) {
    Matrix2x3d d_ab;
    d_ab << iz, 0, -ab.x() * iz, 0, iz, -ab.y() * iz;
    *J = Vector2d(fx, fy).asDiagonal() * D * d_ab;
  }
  return true;
}

Vector2d Camera::Unproject(const Vector2d& pixel) const {
  if (model == CameraModel::kWeakPerspective) {
    return {(pixel.x() - cx) / scale - tx, (pixel.y() - cy) / scale - ty};
  }
  Vector2d target((pixel.x() - cx) / fx, (pixel.y() - cy) / fy);
  if (!HasDistortion()) return target;
  Vector2d nan = Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  Vector2d ab = target, uv;
  Matrix2d D;
  for (int i = 0; i < 50; ++i) {
    // A step may leave the field of view: walk back towards the axis until the model is valid again.
    for (int k = 0; k < 30 && !Distort(distortion, ab, &uv, &D); ++k) ab *= 0.8;
    if (!Distort(distortion, ab, &uv, &D)) return nan;
    const Vector2d step = D.inverse() * (target - uv);
    ab += step;
    if (step.norm() < 1e-13 * (1 + ab.norm())) {
      return Distort(distortion, ab, &uv, &D) && (uv - target).norm() < 1e-9 ? ab : nan;
    }
  }
  return nan;
}

Camera MakePinhole(int width, int height, double focal_px) {
  BODYLOOM_CHECK(width > 0 && height > 0 && focal_px > 0, "MakePinhole: size ", width, "x", height,
                 " and focal length ", focal_px, " px must be positive");
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = focal_px;
  camera.cx = (width - 1) / 2.0;
  camera.cy = (height - 1) / 2.0;
  return camera;
}

}  // namespace bodyloom
