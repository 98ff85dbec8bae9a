// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/frame_cost.h"

namespace bodyloom {

void FrameEvaluator::Evaluate(const FrameLayout& layout, const FrameData& data, const FrameState& state,
                              const Eigen::VectorXd& betas, double log_focal, bool derivatives, FrameSystem* system,
                              FrameResiduals* residuals) {
  sums_.Begin(layout, state, betas, log_focal, derivatives, residuals);
  if (derivatives) {
    int rows = 0;
    data.ForEachTerm([&](const auto& term) { rows += term.num_rows(); });
    sums_.ReserveRows(rows);
  }
  data.ForEachTerm([&](const auto& term) { term.Add(&sums_); });
  sums_.Finish(system);
}

}  // namespace bodyloom
