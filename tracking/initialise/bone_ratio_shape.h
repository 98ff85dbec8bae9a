// SPDX-License-Identifier: Apache-2.0
/// A shape before anything is fitted, from how long the bones look.
#pragma once

#include <Eigen/Core>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/camera.h"
#include "bodyloom/geometry/observations.h"
#include "bodyloom/tracking/initialise/joint_hypotheses.h"

namespace bodyloom {

/// Shape components whose bone lengths have the ratios that the clip shows: a bone's largest projections over the clip
/// (90th percentile, relative to the body's apparent size) give its length wherever it once lay in the image plane.
/// Fits log ratios of torso, thighs, shins, upper arms and forearms with σ = 0.03, and N(0, 1) on each component; a log
/// ratio counts at most 0.35 from the mean body's. Zero without enough frames.
Eigen::VectorXd EstimateShape(const KeypointSequence& keypoints, const Camera& camera, const BodyModel& model,
                              int num_betas, const JointHypothesesOptions& options);

}  // namespace bodyloom
