// SPDX-License-Identifier: Apache-2.0
/// The world of tracks (geometry/world_frame.h): what their files say, or what is assumed where they say nothing.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bodyloom/geometry/arrays.h"
#include "bodyloom/geometry/track.h"
#include "bodyloom/geometry/world_frame.h"

namespace bodyloom {

/// The vertical is known and the ground is not: it lies a few centimetres under the lowest joint (FloorUnder(),
/// render/floor.h; frames of J×3, camera frame, no rows where a frame is unknown), or at the camera when no frame is
/// known. The source is WorldSource::kVertical.
WorldFrame WorldUnderJoints(const Eigen::Vector3d& up_in_camera, const std::vector<MatrixX3d>& joints);

/// Nothing is known: a level camera, the ground under the lowest joint.
WorldFrame AssumedWorld(const std::vector<MatrixX3d>& joints);

/// One world for tracks in one camera frame, whose joints are `joints` (of all of them): of those that say where theirs
/// is, the one surest of its vertical, several people's before one's; AssumedWorld() when none says.
WorldFrame WorldOfTracks(const std::vector<const Track*>& tracks, const std::vector<MatrixX3d>& joints);

}  // namespace bodyloom
