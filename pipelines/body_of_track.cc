// SPDX-License-Identifier: Apache-2.0
#include "pipelines/body_of_track.h"

#include <limits>
#include <utility>

#include "data_tools/body/builtin_body.h"
#include "geometry/body/posed_body.h"

namespace bodyloom {

std::shared_ptr<const BodyModel> BodyOfTrack(const std::string& path, const Track& track) {
  const bool has_fingers = path.empty() && track.motion.body == BuiltinBodyWithHands().name();
  return BodyOrBuiltin(has_fingers ? kBodyWithHands : path);
}

std::shared_ptr<const BodyModel> BodyOfJoints(const std::string& path, int num_joints) {
  const bool has_fingers =
      path.empty() && num_joints != BuiltinBody().num_joints() && num_joints == BuiltinBodyWithHands().num_joints();
  return BodyOrBuiltin(has_fingers ? kBodyWithHands : path);
}

Track TrackOnBody(const BodyModel& body, Track track) {
  constexpr int kBodyJoints = 22, kSmplJoints = 24;
  if (track.motion.body != BuiltinBodyWithHands().name() || body.num_joints() != kSmplJoints) return track;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const int T = track.num_frames();
  RowMatrixXd poses = RowMatrixXd::Constant(T, 3 * kSmplJoints, kNan);
  const bool has_sigma = track.joint_sigma.rows() > 0;
  RowMatrixXd sigma = RowMatrixXd::Constant(has_sigma ? T : 0, kSmplJoints, kNan);
  poses.leftCols(3 * kBodyJoints) = track.motion.poses.leftCols(3 * kBodyJoints);
  if (has_sigma) sigma.leftCols(kBodyJoints) = track.joint_sigma.leftCols(kBodyJoints);
  const MatrixX3d rest = body.RestJoints(track.motion.betas);
  for (int t = 0; t < T; ++t) {
    MatrixX3d joints = MatrixX3d::Constant(kSmplJoints, 3, kNan);
    if (track.motion.HasPose(t)) {
      poses.row(t).tail(3 * (kSmplJoints - kBodyJoints)).setZero();
      joints = PoseSkeleton(body, rest, PoseFromAxisAngle(body, poses.row(t), track.motion.trans.row(t))).joints;
    }
    if (!track.joints.empty()) track.joints[static_cast<size_t>(t)] = std::move(joints);
  }
  track.motion.body = body.name();
  track.motion.poses = std::move(poses);
  track.joint_sigma = std::move(sigma);
  return track;
}

}  // namespace bodyloom
