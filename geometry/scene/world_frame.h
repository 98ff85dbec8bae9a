// SPDX-License-Identifier: Apache-2.0
/// The world of a clip: right-handed, metres, y up (gravity is −y), the ground that people stand on at y = 0.
///
///   point_in_world = rotation · point_in_camera + translation
/// For a moving camera, "camera" is the camera frame that is the clip's scene (geometry/scene/camera_path.h). Its
/// horizontal axes follow the camera's heading: −z is the viewing direction projected to the ground, x is to its right,
/// and the camera is above the origin. A person who faces the camera faces +z. All people of a clip share one.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>

#include "geometry/scene/camera.h"

namespace bodyloom {

/// Source of a world frame.
enum class WorldSource {
  kLevelCamera,  ///< none: the camera is assumed level, the ground lies under the lowest joint
  kVertical,     ///< the vertical was estimated from the clip; the ground lies under the lowest joint
  kGround,       ///< the ground that one person's feet stand on
  kPeople,       ///< the ground that several people stand on
  kGiven,        ///< from a calibration or the caller
};
/// "level camera assumed", "vertical", "ground", "several people", "given".
std::string ToString(WorldSource source);
/// Parses these texts; throws std::invalid_argument for others.
WorldSource WorldSourceFromString(const std::string& text);

struct WorldFrame {
  Eigen::Matrix3d rotation = Eigen::Vector3d(1, -1, -1).asDiagonal();  ///< world_from_camera
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  WorldSource source = WorldSource::kLevelCamera;
  /// Standard deviations; NaN when unknown. Of the vertical: root mean square of the angle to the true one. Of the
  /// ground's height: in the track's scale, which is not observable with one camera.
  double vertical_sigma_deg = std::numeric_limits<double>::quiet_NaN();
  double height_sigma_m = std::numeric_limits<double>::quiet_NaN();

  [[nodiscard]] Eigen::Vector3d PointFromCamera(const Eigen::Vector3d& point_in_camera) const {
    return rotation * point_in_camera + translation;
  }
  /// Transforms points, one per row.
  [[nodiscard]] MatrixX3d PointsFromCamera(const MatrixX3d& points_in_camera) const;
  [[nodiscard]] Eigen::Vector3d up_in_camera() const { return rotation.row(1).transpose(); }
  [[nodiscard]] double camera_height_m() const { return translation.y(); }
  [[nodiscard]] CameraPose camera_pose() const;
  /// One line without a newline: "y up by the ground, within 1.2 deg and 0.02 m; the camera is 1.40 m above it".
  [[nodiscard]] std::string BriefReport() const;
};

/// Returns the world of a vertical (camera axes, any length but zero) and the camera's height above the ground. For a
/// camera within 6° of straight down or up, the heading is that of the image's upper or lower edge. Throws
/// std::invalid_argument for values that are not finite and for a vertical of length zero.
WorldFrame WorldOverGround(const Eigen::Vector3d& up_in_camera, double camera_height_m);

}  // namespace bodyloom
