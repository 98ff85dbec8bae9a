// SPDX-License-Identifier: Apache-2.0
/// A virtual camera that orbits a tracked person and follows it.
#pragma once

#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"
#include "render/view/view_camera.h"

namespace bodyloom {

/// Joints (J×3, camera frame) of every frame of a track; no rows where a frame is lost.
std::vector<MatrixX3d> TrackJoints(const BodyModel& body, const Track& track);

/// The upward direction of a clip, camera frame: that of the track's world if known; else the mean upward axis of the
/// pelvis if it hardly changes (a standing person) and lies within 40° of the camera's; else the camera's own (−y). An
/// estimate with an error of a few degrees, sufficient to draw a level floor.
Eigen::Vector3d EstimatedUp(const Track& track);

struct FollowViewOptions {
  OrbitOptions orbit;
  int width = 0, height = 0;
  bool follows = true;  ///< false: static camera that sees the whole clip's space
  bool turns = false;   ///< other yaws will be requested: distance and centre suit all of them
};

class FollowView {
 public:
  /// `joints` and `timestamps` (seconds) of T frames. The camera follows the root's path smoothed over about a second;
  /// lost frames are interpolated. `others` (other people's joints, may be empty) are kept in view too. Throws
  /// std::invalid_argument when the sizes differ or no frame is known.
  FollowView(const std::vector<MatrixX3d>& joints, const std::vector<double>& timestamps,
             const FollowViewOptions& options, const std::vector<MatrixX3d>& others = {});

  /// The view of frame t, rotated by extra_yaw_deg in addition to the options' yaw.
  [[nodiscard]] View At(int t, double extra_yaw_deg = 0) const;
  /// Centre of the view in frame t, camera frame.
  [[nodiscard]] Eigen::Vector3d CentreAt(int t) const { return centre_.row(t).transpose(); }

 private:
  FollowViewOptions options_;
  std::vector<MatrixX3d> around_centre_;
  View view_;         ///< of a person at the origin, at the options' yaw
  MatrixX3d centre_;  ///< T×3
};

}  // namespace bodyloom
