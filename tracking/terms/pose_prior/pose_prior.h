// SPDX-License-Identifier: Apache-2.0
/// The learned pose prior: which poses people take.
///   ½ w E(x),   E(x) = min_k [ ‖L_k (x − μ_k)‖² + e_k ]      (mixture_prior.h)
/// x: axis-angle of the prior's joints that are estimated, radians. No robust kernel: the minimum over the components
/// is what keeps rare poses possible. Derivatives are those of the nearest component. Runs when a prior was given.
#pragma once

#include "bodyloom/tracking/terms/pose_prior/mixture_prior.h"

namespace bodyloom {

class FrameAccumulator;
struct PlanEntry;
struct TrackSequenceInput;
struct TrackSequenceOptions;

struct PosePriorOfFrame {
  const MixturePrior* mixture = nullptr;  ///< borrowed; null: none
  double weight = 0;                      ///< w

  [[nodiscard]] static int num_rows() { return 0; }  ///< adds to the matrix directly
  void Add(FrameAccumulator* sums) const;
};

PlanEntry PlanPosePrior(const TrackSequenceInput& input, const TrackSequenceOptions& options);

}  // namespace bodyloom
