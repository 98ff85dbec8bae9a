// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/track_world.h"

#include <cmath>
#include <utility>

#include "bodyloom/render/floor.h"

namespace bodyloom {
namespace {

/// More is surer: how it was found, then the spread of its vertical.
std::pair<int, double> SurenessOf(const WorldFrame& world) {
  const double sigma = world.vertical_sigma_deg;
  return {static_cast<int>(world.source), std::isfinite(sigma) ? -sigma : -180};
}

}  // namespace

WorldFrame WorldUnderJoints(const Eigen::Vector3d& up_in_camera, const std::vector<MatrixX3d>& joints) {
  const std::optional<Floor> floor = FloorUnder(joints, up_in_camera);
  WorldFrame world = WorldOverGround(up_in_camera, floor ? -floor->point.dot(floor->up) : 0);
  world.source = WorldSource::kVertical;
  return world;
}

WorldFrame AssumedWorld(const std::vector<MatrixX3d>& joints) {
  WorldFrame world = WorldUnderJoints(-Eigen::Vector3d::UnitY(), joints);
  world.source = WorldSource::kLevelCamera;
  return world;
}

WorldFrame WorldOfTracks(const std::vector<const Track*>& tracks, const std::vector<MatrixX3d>& joints) {
  const WorldFrame* best = nullptr;
  for (const Track* track : tracks) {
    if (!track->world || track->world->source == WorldSource::kLevelCamera) continue;
    if (best == nullptr || SurenessOf(*track->world) > SurenessOf(*best)) best = &*track->world;
  }
  return best != nullptr ? *best : AssumedWorld(joints);
}

}  // namespace bodyloom
