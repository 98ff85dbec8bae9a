// SPDX-License-Identifier: Apache-2.0
/// Cameras that stand still and filmed the same scene: intrinsics, poses and clocks.
#pragma once

#include <cmath>
#include <string>

#include "geometry/scene/camera.h"

namespace bodyloom {

class BodyModel;
struct Track;

/// One camera of a rig. The rig's frame is the frame of its first camera. Standard deviations are 0 where the value was
/// given and NaN where they are not known.
struct RigCamera {
  std::string name;
  Camera camera;
  CameraPose camera_from_rig;
  /// The camera's clock shows t + offset_s + rate (t − middle_s) when that of the first camera shows t. Offset and rate
  /// are 0 for the first camera; a clock that is not known has the offset NaN.
  double offset_s = 0, rate = 0, middle_s = 0;
  double rotation_sigma_rad = 0;   ///< of the pose, about one axis
  double translation_sigma_m = 0;  ///< of the pose, along one axis
  double focal_log_sigma = 0;      ///< of log(focal length)
  double offset_sigma_s = 0, rate_sigma = 0;

  [[nodiscard]] bool HasClock() const { return !std::isnan(offset_s); }
  /// Time of this camera's clock when the first camera's shows `first_s`, and the other way; NaN without a clock.
  [[nodiscard]] double TimeAt(double first_s) const { return first_s + offset_s + rate * (first_s - middle_s); }
  [[nodiscard]] double FirstTimeAt(double own_s) const { return (own_s - offset_s + rate * middle_s) / (1 + rate); }
};

/// The track of a rig's first camera as another one sees it: in the frame of that camera and by its clock, with its
/// intrinsics; the same if it has no clock. The world stays where it is; `playback` is not known of its video. Throws
/// std::invalid_argument for a moving camera.
Track TrackSeenBy(const RigCamera& camera, const BodyModel& body, const Track& track);

/// The track as seen by a camera that stays where the track's is in its first frame, on the same clock: for a motion
/// that is shown elsewhere than over its own video. A track of a static camera is returned unchanged.
Track WithStillCamera(const BodyModel& body, const Track& track);

}  // namespace bodyloom
