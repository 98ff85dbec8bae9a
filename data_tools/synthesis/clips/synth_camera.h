// SPDX-License-Identifier: Apache-2.0
/// Places the camera of a synthetic clip: static, upright, at the smallest distance that keeps the whole motion in
/// view.
#pragma once

#include <string>

#include "geometry/body/body_model.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct SynthCameraOptions {
  CameraModel model = CameraModel::kPinhole;
  int width = 960, height = 720;       ///< pixels
  double focal_px = 0;                 ///< pinhole; 0: 1.1 times the longer side
  std::array<double, 8> distortion{};  ///< pinhole, OpenCV's order
  double yaw_deg = 0;                  ///< about the world's up axis; 0: the camera looks along −z of a y-up world
  double elevation_deg = 8;            ///< positive: from above
  double fill = 0.85;  ///< share of the image's height or width (whichever is tighter) that the clip spans
  [[nodiscard]] bool IsValid(std::string* why) const;
};

struct SynthCamera {
  Camera camera;
  CameraPose pose;  ///< camera from world
  Eigen::Vector3d up_in_camera = -Eigen::Vector3d::UnitY();
};

/// Returns the camera for a motion in the world (vertical by motion.up; Motion::Up::kCamera counts as −y). All frames'
/// bodies are in the image and span `fill` of it. Throws std::invalid_argument when the options are out of range or no
/// frame is finite.
SynthCamera PlaceSynthCamera(const BodyModel& body, const Motion& motion, const SynthCameraOptions& options);

/// Transforms the motion to the camera frame: root rotation R·R_root, translation R(J0 + trans) + t − J0, because the
/// root turns about the pelvis J0 and not about the origin. up becomes Motion::Up::kCamera.
Motion MotionInCamera(const BodyModel& body, const Motion& motion, const CameraPose& pose);

}  // namespace bodyloom
