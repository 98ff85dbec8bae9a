// SPDX-License-Identifier: Apache-2.0
/// Draws a floor under the person: a grid that shows scale and a soft shadow of the body.
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

/// A parallel floor, higher by `height` metres.
Floor RaisedFloor(const Floor& floor, double height);

/// Estimates the floor of a clip: perpendicular to `up`, a few centimetres below the lowest joint (an ankle or foot) of
/// all frames (joints J×3, no rows where a frame is unknown). Empty when no frame is known.
std::optional<Floor> FloorUnder(const std::vector<MatrixX3d>& joints, const Eigen::Vector3d& up);

/// The ground of the track's world, in the track's frame, if it was found or given (WorldSource::kGround, kPeople,
/// kGiven).
std::optional<Floor> FloorOfWorld(const Track& track);

struct FloorGridStyle {
  double spacing_m = 0.5;
  double radius_m = 3;  ///< lines fade out towards this distance from the centre
  double alpha = 0.5;
  Colour colour{96, 104, 120};
};

/// Draws grid lines around the floor point nearest to `centre` (camera frame), at multiples of the spacing from
/// floor.point.
void DrawFloorGrid(const Floor& floor, const Eigen::Vector3d& centre, const FloorGridStyle& style, const Camera& camera,
                   Image* image);

/// Darkens the floor under a mesh (vertices in the camera frame). `strength` in [0, 1]. `slant`: metres that the shadow
/// of a point 1 m above the floor lies to the right of it and further from the camera; by default the light comes a
/// little from the side, (0, 0) is from straight above.
void DrawShadow(const MatrixX3d& vertices_in_camera, const MatrixX3i& faces, const Floor& floor, const Camera& camera,
                double strength, Image* image, const Eigen::Vector2d& slant = {0.22, 0.12});

// The world frame of tracks (geometry/scene/world_frame.h): from their files, or assumed.

/// World frame with a known vertical and an estimated ground: a few centimetres below the lowest joint (FloorUnder(),
/// render/view/floor.h; frames of J×3, camera frame, no rows where a frame is unknown), or at the camera when no frame
/// is known. The source is WorldSource::kVertical.
WorldFrame WorldUnderJoints(const Eigen::Vector3d& up_in_camera, const std::vector<MatrixX3d>& joints);

/// World frame without any information: a level camera, the ground below the lowest joint.
WorldFrame AssumedWorld(const std::vector<MatrixX3d>& joints);

/// One world frame for tracks in one camera frame with `joints` (of all of them): of the tracks' own, the one with the
/// most certain vertical, those estimated from several people first; AssumedWorld() if no track has one.
WorldFrame WorldOfTracks(const std::vector<const Track*>& tracks, const std::vector<MatrixX3d>& joints);

}  // namespace bodyloom
