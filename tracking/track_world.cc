// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/track_world.h"

#include "bodyloom/render/track_world.h"

namespace bodyloom {

WorldFrame WorldOfGround(const GroundSummary& ground, const std::vector<MatrixX3d>& joints) {
  if (!ground.has_up) return AssumedWorld(joints);
  WorldFrame world =
      ground.has_plane ? WorldOverGround(ground.up, ground.camera_height_m) : WorldUnderJoints(ground.up, joints);
  world.source = ground.given ? WorldSource::kGiven : ground.has_plane ? WorldSource::kGround : WorldSource::kVertical;
  world.vertical_sigma_deg = ground.up_sigma_deg;
  world.height_sigma_m = ground.height_sigma_m;
  return world;
}

WorldFrame WorldOfScene(const SharedScene& scene, const std::vector<MatrixX3d>& joints) {
  if (!scene.has_up) return AssumedWorld(joints);
  const KnownGround& ground = scene.ground;
  WorldFrame world =
      ground.has_plane ? WorldOverGround(ground.up, ground.camera_height_m) : WorldUnderJoints(ground.up, joints);
  world.source = scene.source;
  world.vertical_sigma_deg = ground.up_sigma_deg;
  world.height_sigma_m = ground.height_sigma_m;
  return world;
}

}  // namespace bodyloom
