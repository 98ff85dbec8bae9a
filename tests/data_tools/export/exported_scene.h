// SPDX-License-Identifier: Apache-2.0
/// A short clip in a world with a tilted camera, for tests of exported files.
#pragma once

#include <array>

#include "data_tools/body/builtin_body.h"
#include "data_tools/export/export_scene.h"
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

inline ExportScene SceneOf(const Track& track) {
  const std::array<const BodyModel*, 1> bodies = {&BuiltinBody()};
  const std::array<const Track*, 1> tracks = {&track};
  return MakeExportScene(bodies, tracks, TiltedWorld());
}

/// Vertices of frame t of the track in the world, computed via the camera frame.
inline MatrixX3d VerticesInWorld(const Track& track, int t) {
  const BodyPose pose =
      PoseFromAxisAngle(BuiltinBody(), track.motion.poses.row(t).transpose(), track.motion.trans.row(t).transpose());
  return TiltedWorld().PointsFromCamera(PoseVertices(BuiltinBody(), track.motion.betas, pose));
}

}  // namespace bodyloom
