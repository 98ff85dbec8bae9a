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
  std::vector<LiftedFrame> frames;  ///< T; empty when nothing was seen
  double metres = 0;                ///< the body's torso + leg length
  InitialStates initial;
};

/// start->frames → `metres` and `initial`. `body` must have the landmarks of LiftedLandmarks::IsUsable(). Rays come
/// from `camera`; `betas` give the bones' lengths. In every frame in which at least three landmarks are seen the
/// mid-hip is placed by least squares: the position t that brings the lifted landmarks nearest to their rays, Σ c_k²
/// ρ(‖(x_k + t) − its projection on the ray‖²); other frames take their neighbours' depth. Poses by inverse kinematics.
/// Clears start->frames when no frame can be placed.
void StartFromLifted(const KeypointSequence& keypoints, const Camera& camera, const BodyModel& body,
                     const Eigen::VectorXd& betas, LiftedStart* start);

}  // namespace bodyloom
