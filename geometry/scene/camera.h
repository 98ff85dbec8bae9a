// SPDX-License-Identifier: Apache-2.0
/// Camera models, which project points of the camera frame (x right, y down, z forward, metres) to pixels.
/// Pixel centres are at integer coordinates (OpenCV): the top-left pixel covers [-0.5, 0.5]².
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

#include "geometry/math/arrays.h"

namespace bodyloom {

enum class CameraModel {
  kPinhole,          ///< K and OpenCV distortion
  kWeakPerspective,  ///< scaled orthographic with image-plane offset (the camera of the papers)
};

std::string ToString(CameraModel model);
/// Parses "pinhole" or "weak"; throws std::invalid_argument for other names.
CameraModel CameraModelFromString(const std::string& name);

struct Camera {
  CameraModel model = CameraModel::kPinhole;
  int width = 0, height = 0;  ///< image size, pixels

  /// Pinhole: x_px = fx·u + cx with (u, v) the distorted normalised coordinates.
  double fx = 1, fy = 1, cx = 0, cy = 0;
  /// OpenCV order k1 k2 p1 p2 k3 k4 k5 k6; zeros mean no distortion.
  std::array<double, 8> distortion{};

  /// Weak perspective: pixel = scale · (X + tx, Y + ty) + (cx, cy), scale in pixels a metre. Depth is ignored.
  double scale = 1, tx = 0, ty = 0;

  [[nodiscard]] bool HasDistortion() const;
  [[nodiscard]] Eigen::Matrix3d K() const;

  /// Projects `point_in_camera` to a pixel. Valid for z > kMinDepth (pinhole) and any finite point (weak perspective);
  /// elsewhere returns false and sets the outputs to zero. The Jacobian, when requested, is d pixel / d
  /// point_in_camera. Distortion is only meaningful inside the lens' field of view: at and beyond the radius where the
  /// radial model folds back (d r_distorted / d r <= 0) the point is reported invalid.
  bool Project(const Eigen::Vector3d& point_in_camera, Eigen::Vector2d* pixel,
               Matrix2x3d* d_pixel_d_point = nullptr) const;

  /// The normalised, undistorted ray (x/z, y/z) of a pixel (pinhole), by Newton iteration to 1e-12; NaN outside the
  /// lens' field of view. For weak perspective returns the metric (X, Y) of the pixel.
  [[nodiscard]] Eigen::Vector2d Unproject(const Eigen::Vector2d& pixel) const;

  static constexpr double kMinDepth = 1e-3;  ///< metres
};

/// Pinhole camera with square pixels, centred principal point and no distortion.
Camera MakePinhole(int width, int height, double focal_px);

/// A camera's pose: point_in_camera = rotation · point_in_world + translation.
struct CameraPose {
  Eigen::Matrix3d camera_from_world_rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d camera_from_world_translation = Eigen::Vector3d::Zero();
};

}  // namespace bodyloom
