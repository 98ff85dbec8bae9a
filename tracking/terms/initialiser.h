// SPDX-License-Identifier: Apache-2.0
/// L_d of paper A: pulls a frame towards the pose of another system, or towards the start of the solve.
///   ½ λ_d (Σ_j ‖log(R̄_jᵀ R_j)‖²/σ_R² + ‖t − t̄‖²/σ_t²)
/// over the estimated joints; R̄, t̄: the initialiser's, camera frame; σ_R radians, σ_t metres (weak perspective: log
/// scale and offsets). No kernel: λ_d is small, and each stage sets its own (track_stages.h): a pull towards the start
/// in the first one, an initialiser's weight in the others.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "tracking/problem/frame_term.h"

namespace bodyloom {

class ClipTerm;
struct ClipTermInput;
struct PlanEntry;
struct TrackSequenceInput;
struct TrackSequenceOptions;

class InitialiserTerm : public CopyableTerm<InitialiserTerm> {
 public:
  std::vector<Eigen::Matrix3d> rotations;  ///< R̄: J, or empty: no initialiser
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  double weight = 0;                            ///< λ_d
  double sigma = 0.2, translation_sigma = 0.3;  ///< radians, metres

  [[nodiscard]] std::string name() const override { return "initialiser"; }
  [[nodiscard]] int num_rows() const override { return runs() ? static_cast<int>(3 * rotations.size()) + 3 : 0; }
  void Add(FrameAccumulator* sums) const override;
  void BeginStage(const StageSettings& settings) override { weight = settings.initialiser_weight; }

 private:
  [[nodiscard]] bool runs() const { return !rotations.empty() && weight > 0; }
};

/// An entry if an initialiser is given; otherwise the lifter is used (terms/lifted/lifted_pose.h).
std::vector<PlanEntry> PlanInitialiser(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::unique_ptr<ClipTerm> MakeInitialiserTerms(const ClipTermInput& clip);

}  // namespace bodyloom
