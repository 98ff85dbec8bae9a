// SPDX-License-Identifier: Apache-2.0
/// The world of a clip from what its fits found of the vertical and of the ground.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bodyloom/geometry/arrays.h"
#include "bodyloom/geometry/world_frame.h"
#include "bodyloom/tracking/people/shared_scene.h"
#include "bodyloom/tracking/track_summary.h"

namespace bodyloom {

/// Of one person. Where no plane was found the ground lies under the lowest of `joints` (frames of J×3, camera frame; no
/// rows where a frame is unknown), and where no vertical was found either the camera is taken for level.
WorldFrame WorldOfGround(const GroundSummary& ground, const std::vector<MatrixX3d>& joints);

/// Of several people in one view, `joints` of all of them.
WorldFrame WorldOfScene(const SharedScene& scene, const std::vector<MatrixX3d>& joints);

}  // namespace bodyloom
