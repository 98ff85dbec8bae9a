// SPDX-License-Identifier: Apache-2.0
/// Edits of tracks: transfer to another shape or to a baked body, a span of frames, and frozen frames.
#pragma once

#include <Eigen/Core>
#include <span>
#include <utility>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// Placement of a person of another stature.
enum class PersonPlacing {
  kInScene,  ///< on the track's floor, as tall as the shape says
  kInImage,  ///< as tall in the image as the track's own person
};

/// Transfers the track's motion to a person of shape `betas`: "simply transferring the joint rotations between the
/// characters" (Yoon et al., CVPR 2022, section 4.2). Rotations, timestamps, camera and status do not change. The
/// pelvis p (rest joint plus trans) is scaled with the person's leg length about a point c of the floor:
///   p' = c + r (p − c),   trans' = p' − rest joint of `betas`
/// r is the ratio of the two shapes' pelvis heights above their soles at rest, c the median position of the pelvis,
/// moved down (the camera's y) by the track's own height. So step length scales with leg length, stationary feet remain
/// stationary, and with a level camera the floor does not move. Weak perspective: (tx, ty) move by the same rule about
/// their median, the scale stays.
///
/// PersonPlacing::kInImage scales the scene about the camera by s, the ratio of the two shapes' statures at rest, so
/// that the person is as tall in the image as the track's own, on the same pixels of the floor:
///   p' = s c + r (p − c)
/// Stature is not observable with one camera, so the ratio of statures of two people who were fitted to images is as
/// uncertain as either. The track's world and moving camera are scaled too; for weak perspective the scale is divided
/// by s, and the median of (tx, ty) multiplied.
///
/// Shapes that differ in trailing zeros alone are equal: the track is then returned unchanged. Otherwise joints,
/// landmarks and their sigma, which belong to the original shape, are dropped. Throws std::invalid_argument when a
/// shape has more components than the body, or is not finite.
Track WithShape(const BodyModel& body, const Track& track, const Eigen::VectorXd& betas,
                PersonPlacing placed = PersonPlacing::kInScene);

// Baked bodies: a body whose mean shape is one person, clothes included.
//
// v_template' = v_template + shapedirs β + o_i n_i        (o: metres along the vertex normals of the shaped body)
//
// Joints and landmarks keep their positions on the person's bare body: each row of weights w receives the smallest
// change (least squares, on the vertices that it names, its sum kept) that reproduces the bare body's point,
// w' = w + Aᵀ (A Aᵀ)⁺ (point − Σ w_i position'_i),    A = (positions' − their mean)ᵀ,
// which is exact where the row names four vertices that are not in one plane, and the nearest point elsewhere: a
// landmark on a single vertex moves with it. Directions in which the vertices are too flat to reach the point with
// weights of at most 1.5 are left out. Zero betas give the person; other betas still change it.

/// `offsets_m`: one per vertex, or empty for a bare body. Throws std::invalid_argument for another number, values that
/// are not finite, or more betas than the body has.
BodyModelData BakeShape(const BodyModel& body, const Eigen::VectorXd& betas, std::span<const double> offsets_m);

/// The track for the baked body: β = 0, and without joints, which were the bare body's.
Track OfBakedBody(Track track);

/// The frames of a motion from the first with a pose to the last with one: [first, second). {0, 0} if none has a pose.
std::pair<int, int> PosedSpan(const Motion& motion);

/// The frames [begin, end) of a motion. Throws std::invalid_argument for frames out of range.
Motion FramesOfMotion(const Motion& motion, int begin, int end);

/// These frames of a track with their own timestamps. Throws std::invalid_argument for frames out of range.
Track SelectFrames(const Track& track, std::span<const int> frames);

// Frozen frames: time stops while the camera keeps moving ("bullet time").

/// Order of `num_frames` frames in which each is shown in turn and `frame` `count` more times. Throws
/// std::invalid_argument for a frame out of range or a negative count.
std::vector<int> FrozenAt(int num_frames, int frame, int count);

/// The track's frames in that order, `1 / fps` apart with the track's mean rate, from its first timestamp on (a track
/// of one frame: 30 per second). A clock of its own, which no video's `playback` belongs to. Throws
/// std::invalid_argument for frames out of range.
Track FramesInOrder(const Track& track, std::span<const int> frames);

}  // namespace bodyloom
