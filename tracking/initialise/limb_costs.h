// SPDX-License-Identifier: Apache-2.0
/// The four hypotheses of a limb (each of its two bones points towards the camera or away) and their costs: by the
/// learned density of its directions in the torso's frame, and by occlusion behind the torso as implied by confidence.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "geometry/math/direction_bins.h"
#include "geometry/scene/pose_prior.h"
#include "tracking/initialise/joint_rays.h"

namespace bodyloom::hypotheses_internal {

class LimbCosts {
 public:
  /// Borrows all three; without a prior every direction costs the same.
  LimbCosts(const PosePrior* prior, const Lengths& lengths, const JointHypothesesOptions& options);

  /// The four hypotheses of a limb that starts at `start` (camera frame): end points of both bones. A bone whose ray is
  /// too far away for its length lies in the image plane.
  void Hypotheses(const Rays& rays, int limb, const Eigen::Vector3d& start, Eigen::Vector3d middle[4],
                  Eigen::Vector3d end[4]) const;

  [[nodiscard]] bool Usable(const Rays& rays, int limb) const {
    return rays.seen[kLimbs[limb][1]] && rays.seen[kLimbs[limb][2]];
  }

  /// Cost of one hypothesis of a limb.
  [[nodiscard]] double Cost(const Rays& rays, int limb, const Eigen::Matrix3d& torso,
                            const Eigen::Vector3d& torso_centre, const Eigen::Vector3d& start,
                            const Eigen::Vector3d& middle, const Eigen::Vector3d& end) const;

 private:
  [[nodiscard]] double Density(int limb, Eigen::Vector3d upper, Eigen::Vector3d lower) const;

  const Lengths& lengths_;
  const JointHypothesesOptions& options_;
  const PosePrior* prior_ = nullptr;
  std::optional<DirectionBins> bins_;
};

// The candidate torso orientations of a frame, heading × tilt with the roll of the detections, and their costs by
// shoulders, hips, lean and face.

struct TorsoState {
  Eigen::Matrix3d rotation;  ///< camera-from-torso
  double cost = 0;
};

/// All states of one frame whose root lies at `depth` metres.
std::vector<TorsoState> TorsoStates(const Rays& rays, double depth, const Lengths& lengths,
                                    const JointHypothesesOptions& options);

Eigen::Vector3d Centroid(const MatrixX3d& points, const std::array<int, 4>& ids);

}  // namespace bodyloom::hypotheses_internal
