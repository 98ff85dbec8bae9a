// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/dense/dense_whitening.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace bodyloom {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Matrix32d = Eigen::Matrix<double, 3, 2>;

namespace {

int NearestPixel(double x) { return static_cast<int>(std::floor(x + 0.5)); }

}  // namespace

Matrix32d CornerUv(const BodyModel& model, int face) {
  const auto corners = model.data().face_iuv.row(face);
  Matrix32d uv;
  for (int c = 0; c < 3; ++c) uv.row(c) << corners[2 * c], corners[2 * c + 1];
  return uv;
}

Matrix2d PixelByChart(const Matrix3d& corners, const Matrix2x3d& d_pixel_d_x, const Matrix32d& corner_uv) {
  Matrix2d U;
  U << corner_uv.row(1) - corner_uv.row(0), corner_uv.row(2) - corner_uv.row(0);  // rows: edges
  const double area = U.determinant();
  if (std::abs(area) <= 1e-12 * U.squaredNorm() || area == 0) return Matrix2d::Zero();
  Matrix32d E;
  E << (corners.row(1) - corners.row(0)).transpose(), (corners.row(2) - corners.row(0)).transpose();
  return d_pixel_d_x * E * U.transpose().inverse();
}

bool SeeUv(const Camera& camera, const Matrix3d& corners, const Matrix32d& corner_uv, const Vector2d& pixel,
           double min_cosine, SeenUv* seen) {
  const Vector2d xy = camera.Unproject(pixel);
  const bool weak = camera.model == CameraModel::kWeakPerspective;
  const Vector3d origin = weak ? Vector3d(xy.x(), xy.y(), 0) : Vector3d::Zero();
  const Vector3d ray = weak ? Vector3d::UnitZ() : Vector3d(xy.x(), xy.y(), 1);
  const Vector3d a = corners.row(0).transpose() - origin, b = corners.row(1).transpose() - origin,
                 c = corners.row(2).transpose() - origin;
  // Signed volumes of the ray with the edges; they add up to ray · normal.
  const Vector3d volume(ray.dot(b.cross(c)), ray.dot(c.cross(a)), ray.dot(a.cross(b)));
  const double sum = volume.sum(), normal = (b - a).cross(c - a).norm();
  if (!(std::abs(sum) >= min_cosine * normal * ray.norm()) || !(normal > 0)) return false;
  seen->barycentric = volume / sum;
  seen->uv = corner_uv.transpose() * seen->barycentric;
  return true;
}

std::vector<DenseWhitening> WhitenDense(const FrameLayout& layout, const FrameState& state,
                                        const Eigen::VectorXd& betas, double log_focal,
                                        const std::vector<DenseKeypoint>& keypoints, double uv_sigma,
                                        double pixel_sigma_px, const VisibilityBuffer* seen) {
  constexpr double kMinPixelSigma = 0.3, kMinCosine = 0.1;
  const BodyModel& model = *layout.model;
  const bool has_charts = model.data().face_iuv.rows() > 0;
  const Camera camera = layout.CameraAt(state, log_focal);
  Kinematics kinematics;
  kinematics.Set(model, betas, state.rotations, layout.BodyTranslation(state), false);
  PointEvaluator::VertexCache vertices;
  vertices.NewFrame(kinematics);
  std::vector<DenseWhitening> result(keypoints.size());
  for (size_t i = 0; i < keypoints.size(); ++i) {
    const DenseKeypoint& point = keypoints[i];
    DenseWhitening& out = result[i];
    out.whitening = Matrix2d::Identity() / point.sigma_px;
    out.pixel_by_uv.setZero();
    if (!has_charts) continue;
    Matrix3d corners;
    Vector3d barycentric = point.barycentric.cast<double>() / point.barycentric.cast<double>().sum();
    const auto set_corners = [&](int face) {
      for (int c = 0; c < 3; ++c) {
        corners.row(c) = PointEvaluator::VertexPosition(kinematics, model.data().faces(face, c), &vertices).transpose();
      }
    };
    const Vector2d y = point.pixel.cast<double>();
    int face =
        seen != nullptr && y.cwiseAbs().maxCoeff() < 1e6 ? seen->FaceAt(NearestPixel(y.x()), NearestPixel(y.y())) : -1;
    SeenUv at_pixel;
    if (face >= 0 && model.data().face_part[face] == model.data().face_part[point.face]) {
      set_corners(face);
      if (SeeUv(camera, corners, CornerUv(model, face), y, kMinCosine, &at_pixel)) {
        barycentric = at_pixel.barycentric;
      } else {
        face = -1;
      }
    } else {
      face = -1;
    }
    if (face < 0) {
      face = point.face;
      set_corners(face);
    }
    Vector2d pixel;
    Matrix2x3d d_pixel;
    if (!camera.Project(corners.transpose() * barycentric, &pixel, &d_pixel)) continue;
    out.pixel_by_uv = PixelByChart(corners, d_pixel, CornerUv(model, face));
    if (uv_sigma <= 0) continue;
    const double s_px = std::max(pixel_sigma_px, kMinPixelSigma);
    const Matrix2d S =
        s_px * s_px * Matrix2d::Identity() + uv_sigma * uv_sigma * out.pixel_by_uv * out.pixel_by_uv.transpose();
    if (!S.allFinite()) continue;
    Eigen::SelfAdjointEigenSolver<Matrix2d> eigen;
    eigen.computeDirect(S);
    const Eigen::Vector2d root = eigen.eigenvalues().cwiseMax(s_px * s_px).cwiseSqrt().cwiseInverse();
    out.whitening = eigen.eigenvectors() * root.asDiagonal() * eigen.eigenvectors().transpose();
  }
  return result;
}

}  // namespace bodyloom
