// SPDX-License-Identifier: Apache-2.0
/// Hypotheses of 3D joints from one camera's 2D joints, without a start: the solutions of the depth ambiguity, selected
/// over the clip.
///
/// 1. Depth of the root from the image size of torso and legs (the maximum over a few seconds is unforeshortened).
/// 2. Torso orientation: a trellis over heading and tilt; the score of a state is the reprojection of shoulders and
///    hips, the visibility of the parts of the face, the cost of the best limb hypotheses, and the angular speed.
/// 3. Limbs: every limb has four hypotheses (each of its two bones points towards the camera or away: the sphere around
///    the known end meets the viewing ray twice); a trellis over the clip selects them by the learned density of limb
///    directions, by occlusion behind the torso as implied by low confidence, and by continuity.
/// Source: Lee & Chen 1985 for the binary tree of hypotheses; the cues are weighed by JointHypothesesOptions
/// (tracking/problem/track_options.h).
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/pose_prior.h"
#include "tracking/problem/track_options.h"

namespace bodyloom {

/// Index of the torso's axes and joints in `JointHypothesis::points`: CocoNames() order.
struct JointHypothesis {
  MatrixX3d points;                ///< 17×3, camera frame, metres; NaN where nothing is known
  Eigen::Matrix3d torso_rotation;  ///< camera-from-torso (x left, y up, z front)
  double depth = 0;                ///< of the mid-hip, metres
};

struct JointHypothesesResult {
  std::vector<int> frames;                  ///< indices of the frames used, ascending
  std::vector<JointHypothesis> hypotheses;  ///< one for each
  double cost = 0;                          ///< of the chosen paths, for comparing alternatives
};

/// `keypoints` must contain CocoNames() landmarks (any subset); frames without both hips or both shoulders are bridged.
/// Empty when no frame shows a torso. `camera` gives rays; `rest_points` are the body's 17 landmarks in the rest pose,
/// metres.
JointHypothesesResult FindJointHypotheses(const KeypointSequence& keypoints, const Camera& camera,
                                          const MatrixX3d& rest_points, const PosePrior* prior,
                                          const JointHypothesesOptions& options);

/// Orthonormal torso axes of 3D joints in CocoNames() order: y from mid-hip to mid-shoulder, x to the body's left (mean
/// of shoulder and hip lines, made orthogonal), z = x × y to the front. False when degenerate.
bool TorsoFrame(const MatrixX3d& coco17, Eigen::Matrix3d* rotation);

/// The four limbs as CocoNames() indices (start, middle, end); even entries are left.
inline constexpr std::array<std::array<int, 3>, 4> kLimbs = {{{5, 7, 9}, {6, 8, 10}, {11, 13, 15}, {12, 14, 16}}};

}  // namespace bodyloom
