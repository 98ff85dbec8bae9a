// SPDX-License-Identifier: Apache-2.0
#include "geometry/scene/rig.h"

#include <vector>

#include "geometry/base/check.h"
#include "geometry/scene/camera_path.h"
#include "geometry/scene/track.h"

namespace bodyloom {

Track TrackSeenBy(const RigCamera& camera, const BodyModel& body, const Track& track) {
  BODYLOOM_CHECK(!track.HasMovingCamera(), "a rig's track: its camera moves, expected one that stands still");
  const CameraPose& pose = camera.camera_from_rig;
  Track still = track;
  still.camera_from_scene.assign(static_cast<size_t>(track.num_frames()), pose);
  Track seen = TrackInCameras(body, still);
  seen.camera = camera.camera;
  seen.playback = {};
  if (camera.HasClock()) {
    for (double& time : seen.motion.timestamps) time = camera.TimeAt(time);
  }
  seen.world = track.world;
  if (seen.world) {
    // x_world = R_w x + t_w and x = R' (x_camera − t)
    seen.world->rotation = track.world->rotation * pose.camera_from_world_rotation.transpose();
    seen.world->translation = track.world->translation - seen.world->rotation * pose.camera_from_world_translation;
  }
  return seen;
}

Track WithStillCamera(const BodyModel& body, const Track& track) {
  if (!track.HasMovingCamera()) return track;
  RigCamera start;
  start.camera = track.camera;
  start.camera_from_rig = track.camera_from_scene.front();
  start.offset_s = 0;
  Track in_scene = track;
  in_scene.camera_from_scene.clear();
  Track seen = TrackSeenBy(start, body, in_scene);
  seen.playback = track.playback;
  return seen;
}

}  // namespace bodyloom
