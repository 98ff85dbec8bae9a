// SPDX-License-Identifier: Apache-2.0
/// A motion carried over to a person of another shape.
#pragma once

#include <Eigen/Core>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/track.h"

namespace bodyloom {

/// Where a person of another stature stands.
enum class PersonPlacing {
  kInScene,    ///< on the track's floor, as tall as the shape says
  kInPicture,  ///< as tall in the picture as the track's own person
};

/// The track's motion by a person of shape `betas`: "simply transferring the joint rotations between the characters"
/// (Yoon et al., CVPR 2022, section 4.2). Rotations, clock, camera and status stay as they are. The pelvis p (rest
/// joint plus trans) goes where the scene would carry it if it grew with the person's legs about a point c of the
/// floor:
///   p' = c + r (p − c),   trans' = p' − rest joint of `betas`
/// r is the ratio of the two shapes' pelvis heights above their soles at rest, c the median place of the pelvis, moved
/// down (the camera's y) by the track's own height. So steps are as long as the legs, feet that stood still stand
/// still, and the floor stays where it is before a level camera. Weak perspective: (tx, ty) move by the same rule about
/// their median, the scale stays.
///
/// PersonPlacing::kInPicture scales the scene about the camera by s, the ratio of the two shapes' statures at rest, so that the
/// person is as tall in the picture as the track's own, on the same pixels of the floor:
///   p' = s c + r (p − c)
/// One camera does not see how tall anybody is: of two people who were fitted to pictures, the ratio of statures is as much
/// a guess as each of them. What the track says of world and moving camera is scaled with it; of weak perspective the
/// scale is divided by s, and the middle of (tx, ty) multiplied.
///
/// Shapes are equal when they differ in trailing zeros alone: then the track is returned as it is. Otherwise joints,
/// landmarks and their sigma, which are the other person's, are left out. Throws std::invalid_argument when a shape has
/// more components than the body, or is not finite.
Track WithShape(const BodyModel& body, const Track& track, const Eigen::VectorXd& betas,
                PersonPlacing placed = PersonPlacing::kInScene);

}  // namespace bodyloom
