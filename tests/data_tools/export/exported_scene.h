// SPDX-License-Identifier: Apache-2.0
/// A short clip in a world with a tilted camera, for tests of exported files.
#pragma once

#include <array>
#include <cmath>

#include "data_tools/body/builtin_body.h"
#include "data_tools/export/export_scene.h"
#include "geometry/body/hand_skeleton.h"
#include "tests/support/short_track.h"

namespace bodyloom {

inline WorldFrame TiltedWorld() {
  WorldFrame world = WorldOverGround({0.1, -1, -0.25}, 1.3);
  world.source = WorldSource::kGround;
  world.vertical_sigma_deg = 1.5;
  return world;
}

/// Two seconds at six frames a second from t = 0.5 s; frames 3 and 4 are lost.
inline Track TrackWithAGap() {
  Track track = ShortTrack();
  for (double& time : track.motion.timestamps) time += 0.5;
  for (const int t : {3, 4}) {
    track.motion.poses.row(t).setConstant(std::numeric_limits<double>::quiet_NaN());
    track.motion.trans.row(t).setConstant(std::numeric_limits<double>::quiet_NaN());
    track.frame_status[size_t(t)] = FrameStatus::kLost;
  }
  return track;
}

/// The same clip without a gap on the body with hands, which close by up to 60° a joint, each finger at its own pace.
inline Track TrackWithHands() {
  Track track = ShortTrack();
  const BodyModel& body = BuiltinBodyWithHands();
  RowMatrixXd poses = RowMatrixXd::Zero(track.num_frames(), 3 * body.num_joints());
  poses.leftCols(66) = track.motion.poses.leftCols(66);
  for (const HandSide side : {HandSide::kLeft, HandSide::kRight}) {
    const HandSkeleton hand = *FindHand(body, side);
    for (int t = 0; t < track.num_frames(); ++t) {
      for (int i = 0; i < kHandJoints; ++i) {
        const double flexion = 0.5 + 0.5 * std::sin(0.5 * t + 0.7 * i), radial = i % 3 == 0 ? 0.2 * std::cos(t) : 0;
        poses.row(t).segment<3>(3 * hand.joint[i]) =
            (hand.axes[i].col(0) * flexion + hand.axes[i].col(1) * radial).transpose();
      }
    }
  }
  track.motion.poses = poses;
  track.motion.body = body.name();
  return track;
}

inline ExportScene SceneOf(const Track& track, const BodyModel& body = BuiltinBody()) {
  const std::array<const BodyModel*, 1> bodies = {&body};
  const std::array<const Track*, 1> tracks = {&track};
  return MakeExportScene(bodies, tracks, TiltedWorld());
}

/// Vertices of frame t of the track in the world, computed via the camera frame.
inline MatrixX3d VerticesInWorld(const Track& track, int t, const BodyModel& body = BuiltinBody()) {
  const BodyPose pose =
      PoseFromAxisAngle(body, track.motion.poses.row(t).transpose(), track.motion.trans.row(t).transpose());
  return TiltedWorld().PointsFromCamera(PoseVertices(body, track.motion.betas, pose));
}

}  // namespace bodyloom
