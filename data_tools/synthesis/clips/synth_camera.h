// SPDX-License-Identifier: Apache-2.0
/// Places the camera of a synthetic clip: static, upright, at the smallest distance that keeps the whole motion in
/// view.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

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

// Paths of moving cameras for synthetic clips.
//
// kHandHeld  at the position of PlaceSynthCamera(), with shake: rotations about its three axes and translations along
//            them are smooth drifts (smooth_curve.h) of shake_deg and shake_m, with a time constant of 0.6 s
// kWalking   follows the person: as kHandHeld about a position that follows the person's pelvis over the ground,
//            averaged over a second
// kOrbit     circles the person by orbit_deg over the clip, about the vertical through the pelvis, which it follows
//            likewise; a smooth start and end, and the same shake
// For kWalking and kOrbit the camera is placed as if the person stayed in place, so its distance does not depend on
// the person's path.

enum class SynthCameraMotion {
  kStill,
  kHandHeld,
  kWalking,
  kOrbit,
};
/// "still", "hand-held", "walking", "orbit".
std::string ToString(SynthCameraMotion motion);
/// Parses these texts; throws std::invalid_argument for others.
SynthCameraMotion SynthCameraMotionFromString(const std::string& text);

struct SynthCameraPathOptions {
  SynthCameraMotion motion = SynthCameraMotion::kStill;
  double shake_deg = 1.5, shake_m = 0.08;  ///< standard deviations, of each axis
  double orbit_deg = 90;
  [[nodiscard]] bool IsValid(std::string* why) const;
};

struct SynthCameraPath {
  SynthCamera first;                          ///< the camera of frame 0, whose frame is the scene
  std::vector<CameraPose> camera_from_scene;  ///< of every frame; empty for kStill
};

/// Throws std::invalid_argument when options are out of range, no frame is finite, or the camera is a moving one of
/// weak perspective. Deterministic for a seed.
SynthCameraPath MakeSynthCameraPath(const BodyModel& body, const Motion& motion, const SynthCameraOptions& camera,
                                    const SynthCameraPathOptions& path, uint64_t seed);

}  // namespace bodyloom
