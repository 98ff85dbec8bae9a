// SPDX-License-Identifier: Apache-2.0
/// The torso orientations that a frame may have: heading × tilt, turned in the image as the detections are, and what
/// each costs by shoulders, hips, lean and face.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bodyloom/tracking/initialise/joint_rays.h"

namespace bodyloom::hypotheses_internal {

struct TorsoState {
  Eigen::Matrix3d rotation;  ///< camera-from-torso
  double cost = 0;
};

/// All states of one frame whose root lies at `depth` metres.
std::vector<TorsoState> TorsoStates(const Rays& rays, double depth, const Lengths& lengths,
                                    const JointHypothesesOptions& options);

Eigen::Vector3d Centroid(const MatrixX3d& points, const std::array<int, 4>& ids);

}  // namespace bodyloom::hypotheses_internal
