// SPDX-License-Identifier: Apache-2.0
/// Prior against leaning of the trunk towards or away from the camera.
///   ½ w ρ((n·u)² / σ²)        ρ: Geman–McClure with c = kUprightKernel, σ = kUprightSigma
/// u: the root's up axis in the camera frame; n: horizontal, towards the scene. The image hardly depends on this lean
/// (foreshortening is of second order), and people are mostly upright. The kernel saturates, so bending and lying are
/// possible. n is the viewing direction until the clip's vertical is known (terms/ground_contact/clip_ground.h). Runs
/// in every frame whose root is estimated.
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

inline constexpr double kUprightSigma = 0.25, kUprightKernel = 1.5;

class UprightTerm : public CopyableTerm<UprightTerm> {
 public:
  double weight = 0;                                  ///< w
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< n: the direction in which it should not lean

  [[nodiscard]] std::string name() const override { return "upright trunk"; }
  [[nodiscard]] int num_rows() const override { return weight > 0 ? 1 : 0; }
  void Add(FrameAccumulator* sums) const override;
};

/// The reason why the clip's vertical is not used; empty if it is.
std::string WhyNoUp(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::vector<PlanEntry> PlanUpright(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::unique_ptr<ClipTerm> MakeUprightTerms(const ClipTermInput& clip);

}  // namespace bodyloom
