// SPDX-License-Identifier: Apache-2.0
/// Starting poses for the tracker from the lifter's landmarks: positions in the camera frame and joint rotations.
#pragma once

#include <vector>

#include "geometry/scene/camera.h"
#include "geometry/scene/lifter_weights.h"
#include "geometry/scene/observations.h"
#include "tracking/initialise/initial_states.h"
#include "tracking/lifter/lift_keypoints.h"

namespace bodyloom {

struct LiftedStart {
  std::vector<LiftedFrame> frames;  ///< T; empty when nothing was seen
  double metres = 0;                ///< the body's torso + leg length
  InitialStates initial;
};

/// Torso + leg length of the body's rest pose, metres: the unit of LiftedFrame::points.
double LifterMetres(const BodyModel& body, const Eigen::VectorXd& betas);

/// Poses of lifted frames, one a frame of `keypoints`. In every frame in which at least three landmarks are seen the
/// position t of the mid-hip minimises the distance of the lifted landmarks to their rays, Σ c_k² ρ(‖(x_k + t) − its
/// projection on the ray‖²); other frames take their neighbours' depth. Rotations by inverse kinematics; `betas` give
/// the bones' lengths. Empty when no frame can be placed.
std::vector<FrameState> PosesFromLifted(const std::vector<LiftedFrame>& frames, const KeypointSequence& keypoints,
                                        const Camera& camera, const BodyModel& body, const Eigen::VectorXd& betas,
                                        double metres);

/// Fills `metres` and `initial` from start->frames, by PosesFromLifted(). `body` must have the landmarks of
/// LiftedLandmarks::IsUsable(). `camera` gives rays. Clears start->frames when no frame can be placed.
void StartFromLifted(const KeypointSequence& keypoints, const Camera& camera, const BodyModel& body,
                     const Eigen::VectorXd& betas, LiftedStart* start);

}  // namespace bodyloom
