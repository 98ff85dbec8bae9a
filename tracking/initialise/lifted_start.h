// SPDX-License-Identifier: Apache-2.0
/// The lifter's landmarks as a start for the tracker: placed in front of the camera, turned into poses.
#pragma once

#include <vector>

#include "geometry/camera.h"
#include "geometry/lifter_weights.h"
#include "geometry/observations.h"
#include "tracking/initialise/initial_states.h"
#include "tracking/initialise/lift_keypoints.h"

namespace bodyloom {

struct LiftedStart {
  std::vector<LiftedFrame> frames;  ///< T, limbs chosen; empty when nothing was seen
  double metres = 0;                ///< the body's torso + leg length
  InitialStates initial;
};

/// Torso + leg length of the body's rest pose, metres: the unit of LiftedFrame::points.
double LifterMetres(const BodyModel& body, const Eigen::VectorXd& betas);

/// Poses of lifted frames, one a frame of `keypoints`, limbs chosen. In every frame in which at least three landmarks
/// are seen the mid-hip is placed by least squares: the position t that brings the lifted landmarks nearest to their
/// rays, Σ c_k² ρ(‖(x_k + t) − its projection on the ray‖²); other frames take their neighbours' depth. Rotations by
/// inverse kinematics; `betas` give the bones' lengths. Empty when no frame can be placed.
std::vector<FrameState> PosesFromLifted(const std::vector<LiftedFrame>& frames, const KeypointSequence& keypoints,
                                        const Camera& camera, const BodyModel& body, const Eigen::VectorXd& betas,
                                        double metres);

/// Lifts a clip and chooses its limbs; PosesFromLifted(). `body` must have the landmarks of
/// LiftedLandmarks::IsUsable(). Rays come from `camera`.
LiftedStart StartFromLifter(const KeypointSequence& keypoints, const std::vector<char>& cut_before,
                            const Camera& camera, bool focal_known, const BodyModel& body, const Eigen::VectorXd& betas,
                            const LifterWeights& weights, int num_threads);

}  // namespace bodyloom
