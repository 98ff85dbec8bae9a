// SPDX-License-Identifier: Apache-2.0
/// Cloth in a picture of someone who moves: it does not hang straight down, but as if gravity were turned in the picture's
/// plane.
#pragma once

#include <Eigen/Core>

#include "bodyloom/geometry/cloth/cloth_run.h"
#include "bodyloom/geometry/track.h"

namespace bodyloom {

/// Up in the camera frame of a track (render/track_world.h), turned by the swing: cloth falls the other way.
Eigen::Vector3d SwungUp(const Track& track, double swing_rad);

/// For cloth that is looked at once and only has to hang: bodies are posed seldom, and rest soon.
ClothRunOptions HangingCloth(const Track& photo, double swing_rad);

}  // namespace bodyloom
