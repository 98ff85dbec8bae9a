// SPDX-License-Identifier: Apache-2.0
/// The finger joints of a body with SMPL-H's hands: their names, the axes about which they bend, and the 21 landmarks
/// that hand detectors find.
///
/// Joints of a hand, in SMPL-H's order: index 1–3, middle 1–3, pinky 1–3, ring 1–3, thumb 1–3. Joint 1 of a finger is
/// its knuckle (MCP), 2 the middle joint (PIP), 3 the last one (DIP); of the thumb CMC, MCP and IP. Names "l_index1" …
/// "r_thumb3". All first joints hang on the wrist.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "geometry/body/body_model.h"

namespace bodyloom {

enum class HandSide { kLeft, kRight };

inline constexpr int kHandJoints = 15;
inline constexpr int kHandPoints = 21;

/// "index", "middle", "pinky", "ring", "thumb": joints 3i, 3i + 1 and 3i + 2 are those of the i-th.
const std::array<std::string, 5>& FingerNames();

/// The 15 names of a side, in SMPL-H's order.
const std::array<std::string, kHandJoints>& HandJointNames(HandSide side);

/// The names of the landmarks of a body, in the order of MediaPipe and OpenPose: left_wrist, left_thumb_cmc, _mcp, _ip,
/// _tip, left_index_mcp, _pip, _dip, _tip, then middle, ring and pinky.
const std::array<std::string, kHandPoints>& HandLandmarkNames(HandSide side);

/// Pairs of these landmarks that bones join, the one nearer to the wrist first: 20, each landmark but the wrist at the
/// end of one.
std::span<const std::pair<int, int>> HandBones();

/// The 20 landmarks beyond the wrist of one side, in the order of HandLandmarkNames(): joints are the rows of the
/// body's regressor, tips the given vertices (thumb, index, middle, ring, pinky). Throws std::invalid_argument when the
/// body has no such joints.
std::vector<Landmark> HandLandmarks(const BodyModelData& body, HandSide side, const std::array<int, 5>& tip_vertices);

struct HandSkeleton {
  HandSide side = HandSide::kLeft;
  int wrist = -1;                      ///< joint of the body
  std::array<int, kHandJoints> joint;  ///< joints of the body
  /// Orthonormal axes of each joint in the body's T-pose, as columns, for the components of its axis-angle:
  ///   0 flexion   right-hand turns bend the bone to the palm; of the thumb across the palm, to the little finger
  ///   1 radial    turns the bone to the thumb's side; of the thumb away from the palm
  ///   2 twist     along the bone, such that mirrored poses of two mirrored hands have the same three components
  std::array<Eigen::Matrix3d, kHandJoints> axes;
  /// Flexion of the mesh at rest, radians: of a knuckle its bone against the palm's plane, of the joints beyond it the
  /// bone against the bone before it. The flexion of an anatomist is this plus the pose's; 0 of the thumb's CMC.
  std::array<double, kHandJoints> rest_flexion;
};

/// The hand of a body in its mean shape, if it has all finger joints of that side and a wrist.
///
/// With wrist W and knuckles I, P of index and little finger the palm's normal, out of the back of the hand, is
/// n ∝ ±(I − W) × (P − W). A finger flexes about n × b, with b the bone to the next joint (the last bone's to the tip
/// landmark, or as the one before it). The palmar side of the thumb points from its MCP to the point that lies a
/// quarter of the palm's length below P. These axes are within a few degrees of measured ones, which are no hinges.
std::optional<HandSkeleton> FindHand(const BodyModel& body, HandSide side);

/// True for a body with all finger joints of both hands.
bool HasFingers(const BodyModel& body);

}  // namespace bodyloom
