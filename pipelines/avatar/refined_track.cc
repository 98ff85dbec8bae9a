// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/avatar/refined_track.h"

#include "bodyloom/geometry/observations.h"
#include "bodyloom/geometry/posed_body.h"

namespace bodyloom {
namespace {

BodyPose PoseOfFrame(const BodyModel& body, const Motion& motion, int t) {
  return PoseFromAxisAngle(body, motion.poses.row(t).transpose(), motion.trans.row(t).transpose());
}

}  // namespace

std::vector<TrackedPose> TrackedPoses(const BodyModel& body, const Track& track) {
  std::vector<TrackedPose> poses(track.num_frames());
  for (int t = 0; t < track.num_frames(); ++t) {
    if (!track.HasResult(t)) continue;
    poses[t].pose = PoseOfFrame(body, track.motion, t);
    if (track.joint_sigma.rows() != track.num_frames()) continue;
    const auto sigma = track.joint_sigma.row(t);
    poses[t].joint_sigma.assign(sigma.begin(), sigma.end());
  }
  return poses;
}

Track RefinedTrack(const BodyModel& body, const Track& track, const PoseRefiner& refiner,
                   const PoseCorrections& corrections) {
  Track refined = track;
  const int num_joints = body.num_joints();
  const MatrixX3d rest_joints = body.RestJoints(track.motion.betas);
  for (int t = 0; t < track.num_frames(); ++t) {
    if (corrections.IsZero(t)) continue;
    const BodyPose pose = refiner.PoseAt(t, corrections);
    const Eigen::VectorXd turns = AxisAngleFromPose(body, pose);
    for (int j = 0; j < num_joints; ++j) {
      const auto turn = [&](int c) { return corrections.values(t, 3 * j + c); };
      if (turn(0) == 0 && turn(1) == 0 && turn(2) == 0) continue;
      refined.motion.poses.row(t).segment<3>(3 * j) = turns.segment<3>(3 * j).transpose();
    }
    refined.motion.trans.row(t) = pose.trans.transpose();
    const auto frame = static_cast<size_t>(t);
    if (frame < refined.joints.size()) refined.joints[frame] = PoseSkeleton(body, rest_joints, pose).joints;
    if (frame < refined.coco17.size() && refined.coco17[frame].rows() > 0) {
      refined.coco17[frame] = PoseLandmarks(body, track.motion.betas, pose, CocoNames());
    }
  }
  return refined;
}

}  // namespace bodyloom
