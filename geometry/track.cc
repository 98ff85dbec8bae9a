// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/geometry/track.h"

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/observations.h"

namespace bodyloom {

std::string ToString(FrameStatus status) {
  switch (status) {
    case FrameStatus::kTracked:
      return "tracked";
    case FrameStatus::kWeak:
      return "weak";
    case FrameStatus::kInterpolated:
      return "interpolated";
    case FrameStatus::kLost:
      return "lost";
  }
  return "unknown";
}

Camera Track::CameraAt(int t) const {
  BODYLOOM_CHECK(t >= 0 && t < num_frames(), "frame ", t, " is outside the track's ", num_frames(), " frames");
  Camera result = camera;
  if (camera.model == CameraModel::kWeakPerspective) {
    BODYLOOM_CHECK(weak_camera.rows() == num_frames(), "weak_camera has ", weak_camera.rows(), " rows for ",
                   num_frames(), " frames");
    result.scale = weak_camera(t, 0);
    result.tx = weak_camera(t, 1);
    result.ty = weak_camera(t, 2);
  }
  return result;
}

const std::vector<std::string>& CocoNames() {
  static const std::vector<std::string> names = {
      "nose",           "left_eye",   "right_eye",   "left_ear",   "right_ear",   "left_shoulder",
      "right_shoulder", "left_elbow", "right_elbow", "left_wrist", "right_wrist", "left_hip",
      "right_hip",      "left_knee",  "right_knee",  "left_ankle", "right_ankle"};
  return names;
}

bool Track::HasResult(int t) const {
  return motion.HasPose(t) && (camera.model != CameraModel::kWeakPerspective || weak_camera.row(t).allFinite());
}

}  // namespace bodyloom
