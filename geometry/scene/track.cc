// SPDX-License-Identifier: Apache-2.0
#include "geometry/scene/track.h"

#include <stdexcept>

#include "geometry/base/check.h"
#include "geometry/scene/observations.h"

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

void CheckMotion(const Motion& motion, const char* caller) {
  BODYLOOM_CHECK(motion.poses.rows() > 0 && motion.poses.cols() % 3 == 0 && motion.poses.cols() > 0, caller, ": poses ",
                 motion.poses.rows(), "x", motion.poses.cols(), ", expected frames x 3 joints");
  BODYLOOM_CHECK(motion.trans.rows() == motion.poses.rows() &&
                     motion.timestamps.size() == static_cast<size_t>(motion.poses.rows()),
                 caller, ": ", motion.poses.rows(), " poses, ", motion.trans.rows(), " translations, ",
                 motion.timestamps.size(), " timestamps");
  BODYLOOM_CHECK(motion.poses.allFinite() && motion.trans.allFinite(), caller,
                 ": poses or translations are not finite");
}

void RequireTrackFitsBody(const Track& track, const BodyModel& body, const std::string& where) {
  if (track.motion.poses.cols() <= 3 * body.num_joints()) return;
  throw std::runtime_error(Concatenate(where, ": ", track.motion.poses.cols() / 3, " joints (body '", track.motion.body,
                                       "'), the body '", body.name(), "' has ", body.num_joints(),
                                       "; give the track's own with --body"));
}

}  // namespace bodyloom
