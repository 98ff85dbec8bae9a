// SPDX-License-Identifier: Apache-2.0
/// Learns the pose prior from motions: a mixture of Gaussians over joint rotations by expectation–maximisation, and
/// densities of limb directions by histograms.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/pose_prior.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct LearnPosePriorOptions {
  int num_components = 8;
  double sample_rate = 15;  ///< frames per second that are used
  double floor_rad = 0.06;  ///< standard deviation added to every rotation, for variation that motion capture lacks
  double shrinkage = 0.1;   ///< shrinkage of each covariance towards its diagonal
  int num_directions = 200;
  double direction_sigma_deg = 12;  ///< smoothing of the direction densities
  double uniform_share = 0.02;      ///< uniform share of the direction densities, so that none is zero
  int iterations = 40;
  uint64_t seed = 1;
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// Every clip is weighted by the square root of its length and also used mirrored, so the prior is symmetric. Motions
/// must have the body's joints (24 on SMPL's tree); throws std::invalid_argument otherwise or without frames.
PosePrior LearnPosePrior(const std::vector<Motion>& motions, const BodyModel& body,
                         const LearnPosePriorOptions& options);

/// The pose seen in a mirror (x → −x): left and right joints exchanged, rotation vectors (x, y, z) → (x, −y, −z).
Eigen::VectorXd MirrorPose(const BodyModel& body, const Eigen::VectorXd& axis_angle);

}  // namespace bodyloom
