// SPDX-License-Identifier: Apache-2.0
/// A motion carried over to a person of another shape.
#pragma once

#include <Eigen/Core>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/track.h"

namespace bodyloom {

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
/// Shapes are equal when they differ in trailing zeros alone: then the track is returned as it is. Otherwise joints,
/// landmarks and their sigma, which are the other person's, are left out. Throws std::invalid_argument when a shape has
/// more components than the body, or is not finite.
Track WithShape(const BodyModel& body, const Track& track, const Eigen::VectorXd& betas);

}  // namespace bodyloom
