// SPDX-License-Identifier: Apache-2.0
/// Weak prior towards straight knees.
///   ½ w² Σ_k ρ(θ_k²)        ρ: Geman–McClure with c = kStraightKneesKernel, radians
/// θ_k: flexion of knee k, radians: the x component of its axis-angle (joint_limits.h has the frame; 0 in the T-pose,
/// where thigh and shin are in line). A detector whose hips lie lower than the body's makes thighs short in the image,
/// and a short thigh looks like a bent knee; a bend of up to 40° out of the image plane hardly changes the image, as
/// foreshortening is of second order. The kernel releases knees that are bent far, as in a squat: the pull is largest
/// at 13° and an eighth of that at 60°. Runs in every frame, for both knees if they are estimated and w > 0.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "tracking/problem/frame_term.h"

namespace bodyloom {

class ClipTerm;
struct ClipTermInput;
struct PlanEntry;
struct TrackSequenceInput;
struct TrackSequenceOptions;

inline constexpr double kStraightKneesKernel = 0.4;

/// Joint indices of the left and the right knee; −1 if the body has none of that name.
std::array<int, 2> FindKnees(const BodyModel& model);

class StraightKneesTerm : public CopyableTerm<StraightKneesTerm> {
 public:
  StraightKneesTerm() = default;
  StraightKneesTerm(const std::array<int, 2>& knees, double weight) : knees(knees), weight(weight) {}

  std::array<int, 2> knees = {-1, -1};  ///< FindKnees()
  double weight = 0;                    ///< w, 1/rad

  [[nodiscard]] std::string name() const override { return "straight knees"; }
  [[nodiscard]] int num_rows() const override { return weight > 0 ? 2 : 0; }
  void Add(FrameAccumulator* sums) const override;
};

/// An entry if w > 0.
std::vector<PlanEntry> PlanStraightKnees(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::unique_ptr<ClipTerm> MakeStraightKneesTerms(const ClipTermInput& clip);

}  // namespace bodyloom
