// SPDX-License-Identifier: Apache-2.0
#include "render/view/view_camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"
#include "geometry/math/rotation.h"

namespace bodyloom {

using Eigen::Vector3d;

Camera ScaledCamera(const Camera& camera, double factor) {
  BODYLOOM_CHECK(factor > 0, "camera scale ", factor, " must be positive");
  Camera scaled = camera;
  scaled.width = static_cast<int>(std::lround(camera.width * factor));
  scaled.height = static_cast<int>(std::lround(camera.height * factor));
  scaled.fx *= factor;
  scaled.fy *= factor;
  scaled.scale *= factor;
  scaled.cx = factor * (camera.cx + 0.5) - 0.5;
  scaled.cy = factor * (camera.cy + 0.5) - 0.5;
  return scaled;
}

double PixelsPerMetre(const Camera& camera, double depth_m) {
  if (camera.model == CameraModel::kWeakPerspective) return camera.scale;
  return depth_m > Camera::kMinDepth ? camera.fy / depth_m : 0;
}

MatrixX3d View::Apply(const MatrixX3d& points) const {
  MatrixX3d result = points * from_camera.camera_from_world_rotation.transpose();
  result.rowwise() += from_camera.camera_from_world_translation.transpose();
  return result;
}

View OrbitView(const std::vector<MatrixX3d>& points, int width, int height, const OrbitOptions& options) {
  const Vector3d up = options.up_in_camera.normalized();
  const double radians = M_PI / 180;
  // Rotate the scene about `up`, align the camera with `up`, then tilt it.
  const Eigen::Matrix3d upright = RotationBetweenDirections(up, -Vector3d::UnitY());
  const Eigen::Matrix3d R = RotationFromAxisAngle(Vector3d(options.elevation_deg * radians, 0, 0)) * upright *
                            RotationFromAxisAngle(-options.yaw_deg * radians * up);
  View view;
  view.camera = MakePinhole(width, height, 1.6 * std::max(width, height));

  std::vector<Vector3d> turned;
  for (const MatrixX3d& frame : points) {
    for (int i = 0; i < frame.rows(); ++i) {
      const Vector3d x = R * frame.row(i).transpose();
      if (x.allFinite()) turned.push_back(x);
    }
  }
  BODYLOOM_CHECK(!turned.empty(), "no finite point to look at");
  Eigen::AlignedBox3d box;
  for (const Vector3d& x : turned) box.extend(x);
  const Vector3d centre = box.center();
  double distance = 0;
  for (const Vector3d& x : turned) {
    const Vector3d r = x - centre;
    const double half_w = view.camera.width / 2.0, half_h = view.camera.height / 2.0, f = view.camera.fx;
    distance = std::max({distance, f * (std::abs(r.x()) + options.margin_m) / half_w - r.z(),
                         f * (std::abs(r.y()) + options.margin_m) / half_h - r.z()});
  }
  view.from_camera.camera_from_world_rotation = R;
  view.from_camera.camera_from_world_translation = Vector3d(0, 0, distance) - centre;
  return view;
}

}  // namespace bodyloom
