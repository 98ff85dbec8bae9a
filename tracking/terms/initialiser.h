// SPDX-License-Identifier: Apache-2.0
/// L_d of paper A: a frame stays near the pose of another system, or near the pose that the solve starts from.
///   ½ λ_d (Σ_j ‖log(R̄_jᵀ R_j)‖²/σ_R² + ‖t − t̄‖²/σ_t²)
/// over the estimated joints; R̄, t̄: the initialiser's, camera frame; σ_R radians, σ_t metres (weak perspective: log
/// scale and offsets). No kernel: λ_d is small, and each stage sets its own (track_stages.h): a pull towards the start
/// in the first one, an initialiser's weight in the others.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace bodyloom {

class FrameAccumulator;
struct PlanEntry;
struct TrackSequenceInput;
struct TrackSequenceOptions;

struct InitialiserOfFrame {
  std::vector<Eigen::Matrix3d> rotations;  ///< R̄: J, or empty: no initialiser
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  double weight = 0;                            ///< λ_d
  double sigma = 0.2, translation_sigma = 0.3;  ///< radians, metres

  [[nodiscard]] static int num_rows() { return 0; }  ///< adds to the matrix directly
  void Add(FrameAccumulator* sums) const;
};

/// Of the initialiser, or of the lifter in its place (terms/lifted/lifted_pose.h).
PlanEntry PlanInitialiser(const TrackSequenceInput& input, const TrackSequenceOptions& options);

}  // namespace bodyloom
