// SPDX-License-Identifier: Apache-2.0
/// A motion carried over to a person of another shape.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"

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
/// PersonPlacing::kInPicture scales the scene about the camera by s, the ratio of the two shapes' statures at rest, so
/// that the person is as tall in the picture as the track's own, on the same pixels of the floor:
///   p' = s c + r (p − c)
/// One camera does not see how tall anybody is: of two people who were fitted to pictures, the ratio of statures is as
/// much a guess as each of them. What the track says of world and moving camera is scaled with it; of weak perspective
/// the scale is divided by s, and the middle of (tx, ty) multiplied.
///
/// Shapes are equal when they differ in trailing zeros alone: then the track is returned as it is. Otherwise joints,
/// landmarks and their sigma, which are the other person's, are left out. Throws std::invalid_argument when a shape has
/// more components than the body, or is not finite.
Track WithShape(const BodyModel& body, const Track& track, const Eigen::VectorXd& betas,
                PersonPlacing placed = PersonPlacing::kInScene);

// A body whose mean shape is one person, clothes included.
//
// v_template' = v_template + shapedirs β + o_i n_i        (o: metres along the vertex normals of the shaped body)
//
// Joints and landmarks stay where the person's bare body has them: each row of weights w is changed by the least
// (in squares, on the vertices that it names, its sum kept) that gives the bare body's point back,
// w' = w + Aᵀ (A Aᵀ)⁺ (point − Σ w_i position'_i),    A = (positions' − their mean)ᵀ,
// which is exact where the row names four vertices that are not in one plane, and as near as its vertices allow
// elsewhere: a landmark on a single vertex moves with it. Directions in which the vertices are too flat to reach the
// point with weights of at most 1.5 count as none. Zero betas are the person; other betas still change it.

/// `offsets_m`: one a vertex, or empty for a bare body. Throws std::invalid_argument for another number, values that
/// are not finite, or more betas than the body has.
BodyModelData BakeShape(const BodyModel& body, const Eigen::VectorXd& betas, std::span<const double> offsets_m);

/// A track of the person as the baked body follows it: β = 0, and without joints, which were the bare body's.
Track OfBakedBody(Track track);

// Time that stands still while the camera goes on: bullet time.

/// Which frame of `num_frames` is shown when: each in turn, and `frame` `count` times more. Throws
/// std::invalid_argument for a frame that is not there or a negative count.
std::vector<int> FrozenAt(int num_frames, int frame, int count);

/// The track's frames in that order, `1 / fps` apart with the track's mean rate, from its first timestamp on (a track
/// of one frame: 30 a second). Throws std::invalid_argument for frames that it has not.
Track FramesInOrder(const Track& track, std::span<const int> frames);

}  // namespace bodyloom
