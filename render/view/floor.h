// SPDX-License-Identifier: Apache-2.0
/// A floor under the person: a grid that gives pictures a scale and a soft shadow that ties the body to the ground.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/track.h"
#include "geometry/scene/world_frame.h"
#include "render/image/image.h"

namespace bodyloom {

/// A plane in the camera frame.
struct Floor {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d up = -Eigen::Vector3d::UnitY();
};

/// The floor on which a person stands in a clip: level with `up`, a few centimetres under the lowest joint, which is an
/// ankle or a foot, of all frames (joints J×3, no rows where a frame is unknown). Nothing when no frame is known.
std::optional<Floor> FloorUnder(const std::vector<MatrixX3d>& joints, const Eigen::Vector3d& up);

struct FloorGridStyle {
  double spacing_m = 0.5;
  double radius_m = 3;  ///< lines fade out towards this distance from the centre
  double alpha = 0.5;
  Colour colour{96, 104, 120};
};

/// Grid lines around the floor point nearest to `centre` (camera frame), at whole multiples of the spacing from
/// floor.point.
void DrawFloorGrid(const Floor& floor, const Eigen::Vector3d& centre, const FloorGridStyle& style, const Camera& camera,
                   Image* image);

/// Darkens the floor under a mesh (vertices in the camera frame), lit from above and a little from the side.
/// `strength` in [0, 1].
void DrawShadow(const MatrixX3d& vertices_in_camera, const MatrixX3i& faces, const Floor& floor, const Camera& camera,
                double strength, Image* image);

// The world of tracks (geometry/scene/world_frame.h): what their files say, or what is assumed where they say nothing.

/// The vertical is known and the ground is not: it lies a few centimetres under the lowest joint (FloorUnder(),
/// render/view/floor.h; frames of J×3, camera frame, no rows where a frame is unknown), or at the camera when no frame
/// is known. The source is WorldSource::kVertical.
WorldFrame WorldUnderJoints(const Eigen::Vector3d& up_in_camera, const std::vector<MatrixX3d>& joints);

/// Nothing is known: a level camera, the ground under the lowest joint.
WorldFrame AssumedWorld(const std::vector<MatrixX3d>& joints);

/// One world for tracks in one camera frame, whose joints are `joints` (of all of them): of those that say where theirs
/// is, the one surest of its vertical, several people's before one's; AssumedWorld() when none says.
WorldFrame WorldOfTracks(const std::vector<const Track*>& tracks, const std::vector<MatrixX3d>& joints);

}  // namespace bodyloom
