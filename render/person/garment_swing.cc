// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/person/garment_swing.h"

#include <Eigen/Geometry>

#include "bodyloom/render/track_world.h"

namespace bodyloom {

Eigen::Vector3d SwungUp(const Track& track, double swing_rad) {
  return Eigen::AngleAxisd(swing_rad, Eigen::Vector3d::UnitZ()) * WorldOfTracks({&track}, track.joints).up_in_camera();
}

ClothRunOptions HangingCloth(const Track& photo, double swing_rad) {
  ClothRunOptions options;
  options.up = SwungUp(photo, swing_rad);
  options.tick_s = 0.1;
  options.move_in_s = 0.5;
  options.settle_s = 0.5;
  options.cloth.substep_s = 1.0 / 160;
  return options;
}

}  // namespace bodyloom
