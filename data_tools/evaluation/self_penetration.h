// SPDX-License-Identifier: Apache-2.0
/// Self-penetration of a posed body: depth of its parts in each other, for example of a forearm in the trunk.
///
/// Parts. On bodies with SMPL's joints: trunk (pelvis, spine, collars), head (neck, jaw, eyes), and on each side upper
/// arm, forearm, hand (fingers), thigh, shank, foot. Other bodies: one part per joint. A vertex belongs to the part
/// with most of its skinning weight, a face to the part of most of its corners. Each part is a solid (capped_mesh.h).
///
/// A vertex penetrates if it lies inside another part's solid, and its depth is the distance to that part's skin.
/// Contact of neighbouring parts, and of parts close to each other at rest, is excluded: in the rest pose of the
/// track's own shape, the vertex is compared with every vertex of the part; where the nearest is closer than
///   9 % of the body's height, when the part is joined to the vertex's own (a joint of one is the parent of one of
///     the other): an upper arm may bend into the armpit and a shank against the thigh, not through them;
///   3 % of it otherwise: armpits, crotch, inner thighs, hands spread at rest
/// the pair is never tested. Distances at rest are to vertices, not faces: coarse bodies exclude a little less.
///
/// Model surfaces do not deform on contact: in reality, too, arms that rest on the trunk and deep squats press flesh by
/// a centimetre or two. Compare with the value of the truth or of another track, rather than with 0.
#pragma once

#include <string>
#include <vector>

#include "data_tools/evaluation/evaluation.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct SelfPenetrationOptions {
  double joined_share = 0.09, other_share = 0.03;  ///< of the body's height: pairs closer at rest are not tested
  int num_threads = 1;                             ///< the result is the same
};

/// The part of each joint, and the names of the parts.
struct BodyParts {
  std::vector<std::string> names;
  std::vector<int> of_joint;
};
BodyParts PartsOfBody(const BodyModel& body);

/// One frame.
struct FramePenetration {
  double deepest_m = 0;                   ///< 0: nothing penetrates
  int vertices = 0;                       ///< inside another part
  int vertex = -1;                        ///< the deepest one, −1: none
  int part = -1, in = -1;                 ///< its part, and the part in which it lies
  std::vector<double> deepest_of_pair_m;  ///< parts × parts, [part · parts + in]
};

struct SelfPenetration {
  std::vector<std::string> parts;
  std::vector<FramePenetration> frames;  ///< of those that have a pose
  int num_vertices = 0;
};

/// Poses the body in each of `frames` (numbers of frames of the motion; those without a pose are left out). Throws
/// std::invalid_argument when a pose or shape does not fit the body, a share is negative or not finite.
SelfPenetration MeasureSelfPenetration(const Motion& motion, const std::vector<int>& frames, const BodyModel& body,
                                       const SelfPenetrationOptions& options = {});

/// Adds, over all frames measured (NaN: none):
///   self_penetration_mm              mean of the deepest vertex's depth
///   self_penetration_p95_mm          95th percentile of it
///   self_penetration_frames_percent  share of the frames in which it is above 10 mm
///   self_penetration_vertices_percent  mean share of the vertices that penetrate
/// each after `prefix` ("gt_" for the truth), and, without a prefix, a breakdown: the mean of the deepest depth of each
/// pair of parts that penetrate anywhere.
void AddSelfPenetration(const SelfPenetration& penetration, const std::string& prefix, Evaluation* evaluation);

}  // namespace bodyloom
