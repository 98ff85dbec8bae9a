// SPDX-License-Identifier: Apache-2.0
/// Finds a starting pose for every frame, from the user's initialiser or from the observations alone.
#pragma once

#include <string>
#include <vector>

#include "tracking/problem/frame_layout.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"

namespace bodyloom {

struct InitialStates {
  std::vector<FrameState> states;      ///< T, or empty when no frame shows a torso
  std::vector<char> from_observation;  ///< T: a hypothesis was made for this frame (others are interpolated)
  Eigen::VectorXd betas;  ///< of the clip's bone ratios (initialiser: its own, or zero), of the stature given
  double cost = 0;        ///< of the hypotheses
};

struct LiftedStart;

/// The initialiser's poses if given, with missing frames interpolated as below; else the lifter's, if there is one that
/// can use the observations; else joint hypotheses, converted to poses by inverse kinematics and interpolated on SO(3)
/// to every frame. `keypoints`: JointsToStartFrom(); null only with an initialiser. `lifted`, if given, receives the
/// lifter's predictions (its frames are empty if it did not run or no landmark was seen); with an initialiser the
/// lifter runs only for the vertical and the ground, when they are requested.
InitialStates FindInitialStates(const TrackSequenceInput& input, const KeypointSequence* keypoints,
                                const FrameLayout& layout, const TrackSequenceOptions& options,
                                LiftedStart* lifted = nullptr);

/// The reason why the lifter does not run; empty if it does.
std::string WhyNotLifted(const TrackSequenceInput& input, const TrackSequenceOptions& options);
/// The reason why the lifter gives neither the start nor the term L_d (it does not run, or there is an initialiser);
/// empty if it gives both.
std::string WhyNoLifter(const TrackSequenceInput& input, const TrackSequenceOptions& options);

/// COCO-17 keypoints estimated from dense ones: each landmark is the mean pixel of the surface points near it in the
/// rest pose, weighted by exp(−d²/2(6 cm)²); confidence grows with the number of such points. Good enough to start
/// from.
KeypointSequence JointsFromDense(const BodyModel& model, const DenseSequence& dense);

/// The 2D joints to start from and to find cuts by: the input's, else JointsFromDense() put into `from_dense`, else
/// null.
const KeypointSequence* JointsToStartFrom(const TrackSequenceInput& input, KeypointSequence* from_dense);

/// Least-squares weak-perspective camera (log scale, tx, ty) from points (camera frame axes, metres) to pixels; false
/// with fewer than two distinct points.
bool FitWeakCamera(const std::vector<Eigen::Vector3d>& points, const std::vector<Eigen::Vector2d>& pixels, double cx,
                   double cy, Eigen::Vector3d* log_scale_tx_ty);

}  // namespace bodyloom
