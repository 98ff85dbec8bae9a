// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/evaluation/triangulation.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

TriangulatedPoint TriangulatePoint(std::span<const Sighting> sightings) {
  TriangulatedPoint result;
  // Nearest point to all rays: Σ (I − d dᵀ)(X − c) = 0.
  Matrix3d A = Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  for (const Sighting& s : sightings) {
    const Vector2d ray = s.camera->Unproject(s.pixel);
    if (!ray.allFinite()) return result;
    const Matrix3d world_from_camera = s.pose->camera_from_world_rotation.transpose();
    const Vector3d d = (world_from_camera * Vector3d(ray.x(), ray.y(), 1)).normalized();
    const Vector3d centre = -world_from_camera * s.pose->camera_from_world_translation;
    const Matrix3d across = Matrix3d::Identity() - d * d.transpose();
    A += across;
    b += across * centre;
  }
  // Two rays at the angle γ give det A = 2 sin²γ; a single ray or parallel ones give 0.
  const double sine = std::sin(std::numbers::pi / 180);
  if (A.determinant() < 2 * sine * sine) return result;
  Vector3d X = A.ldlt().solve(b);

  constexpr int kIterations = 10;
  for (int iteration = 0; iteration <= kIterations; ++iteration) {
    Matrix3d H = Matrix3d::Zero();
    Vector3d g = Vector3d::Zero();
    double squares = 0;
    for (const Sighting& s : sightings) {
      const Matrix3d& R = s.pose->camera_from_world_rotation;
      Vector2d pixel;
      Matrix2x3d d_pixel;
      if (!s.camera->Project(R * X + s.pose->camera_from_world_translation, &pixel, &d_pixel)) return result;
      const Matrix2x3d J = d_pixel * R;
      const Vector2d r = pixel - s.pixel;
      H.noalias() += J.transpose() * J;
      g.noalias() += J.transpose() * r;
      squares += r.squaredNorm();
    }
    result.point_in_world = X;
    result.rms_px = std::sqrt(squares / static_cast<double>(sightings.size()));
    const Vector3d step = H.ldlt().solve(g);
    if (!step.allFinite()) return result;
    if (step.norm() < 1e-9) break;
    X -= step;
  }
  result.is_valid = true;
  return result;
}

}  // namespace bodyloom
