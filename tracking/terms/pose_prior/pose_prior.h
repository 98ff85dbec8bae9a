// SPDX-License-Identifier: Apache-2.0
/// The learned pose prior: which poses people take.
///   ½ w E(x),   E(x) = min_k [ ‖L_k (x − μ_k)‖² + e_k ]      (mixture_prior.h)
/// x: axis-angle of the prior's joints that are estimated, radians. No robust kernel: the minimum over the components
/// is what keeps rare poses possible. Derivatives are those of the nearest component. Runs when a prior was given.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bodyloom/tracking/problem/frame_term.h"
#include "bodyloom/tracking/terms/pose_prior/mixture_prior.h"

namespace bodyloom {

class ClipTerm;
struct ClipTermInput;
struct PlanEntry;
struct TrackSequenceInput;
struct TrackSequenceOptions;

class PosePriorTerm : public CopyableTerm<PosePriorTerm> {
 public:
  std::shared_ptr<const MixturePrior> mixture;  ///< null: none
  double weight = 0;                            ///< w

  [[nodiscard]] std::string name() const override { return "pose prior"; }
  /// One by one; sums take none.
  [[nodiscard]] int num_rows() const override {
    return runs() ? static_cast<int>(3 * mixture->joints().size()) + 1 : 0;
  }
  void Add(FrameAccumulator* sums) const override;

 private:
  [[nodiscard]] bool runs() const { return mixture != nullptr && !mixture->empty() && weight > 0; }
  void AddOneByOne(const Eigen::VectorXd& x, int component, double energy, FrameAccumulator* sums) const;
};

std::vector<PlanEntry> PlanPosePrior(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::unique_ptr<ClipTerm> MakePosePriorTerms(const ClipTermInput& clip);

}  // namespace bodyloom
