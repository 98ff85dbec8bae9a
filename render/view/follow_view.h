// SPDX-License-Identifier: Apache-2.0
/// A second camera that turns about a tracked person and moves along with it.
#pragma once

#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"
#include "render/view/view_camera.h"

namespace bodyloom {

/// Joints (J×3, camera frame) of every frame of a track; no rows where a frame is lost.
std::vector<MatrixX3d> TrackJoints(const BodyModel& body, const Track& track);

/// The vertical of a clip, camera frame: that of the track's world, when it was found; else the mean direction of the
/// pelvis' upward axis, when it hardly changes (a person on its feet) and lies within 40° of the camera's; the camera's
/// own (−y) otherwise. A tilted camera needs no more than this for a floor that looks level; it is an estimate, a few
/// degrees off.
Eigen::Vector3d EstimatedUp(const Track& track);

struct FollowViewOptions {
  OrbitOptions orbit;
  int width = 0, height = 0;
  bool follows = true;  ///< false: stands still and sees the whole clip's space
  bool turns = false;   ///< will be seen from other yaws: far enough and centred for all of them
};

class FollowView {
 public:
  /// `joints` and `timestamps` (seconds) of T frames. The camera moves along the root's path blurred over about a
  /// second; lost frames are bridged. `others` (other people's joints, may be empty) are kept in sight too. Throws
  /// std::invalid_argument when the sizes differ or no frame is known.
  FollowView(const std::vector<MatrixX3d>& joints, const std::vector<double>& timestamps,
             const FollowViewOptions& options, const std::vector<MatrixX3d>& others = {});

  /// The view of frame t, turned by extra_yaw_deg beyond the options' yaw.
  [[nodiscard]] View At(int t, double extra_yaw_deg = 0) const;
  /// What it is centred on in frame t, camera frame.
  [[nodiscard]] Eigen::Vector3d CentreAt(int t) const { return centre_.row(t).transpose(); }

 private:
  FollowViewOptions options_;
  std::vector<MatrixX3d> around_centre_;
  View view_;         ///< of a person at the origin, at the options' yaw
  MatrixX3d centre_;  ///< T×3
};

}  // namespace bodyloom
