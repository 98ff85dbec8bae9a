// SPDX-License-Identifier: Apache-2.0
/// A starting pose for every frame: from the user's initialiser, or from nothing.
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

/// The initialiser's poses when given, frames that it lacks between its others as below; else the lifter's, when there
/// is one that can read the observations; else joint hypotheses turned into poses by inverse kinematics and
/// interpolated on SO(3) to every frame. `keypoints`: JointsToStartFrom(); null only with an initialiser. `lifted`,
/// when given, receives what the lifter predicted (its frames are empty when it was not run or saw nothing); with an
/// initialiser the lifter runs for the vertical and the ground alone, when they are wanted.
InitialStates FindInitialStates(const TrackSequenceInput& input, const KeypointSequence* keypoints,
                                const FrameLayout& layout, const TrackSequenceOptions& options,
                                LiftedStart* lifted = nullptr);

/// Why the lifter does not run, or empty when it does.
std::string WhyNotLifted(const TrackSequenceInput& input, const TrackSequenceOptions& options);
/// Why it does not give the start and stay as L_d, or empty when it does: it does not run, or there is an initialiser.
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
