// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/frame_cost.h"

#include "bodyloom/tracking/moving_camera.h"

namespace bodyloom {

void FrameEvaluator::Evaluate(const FrameLayout& layout, const FrameData& data, const FrameState& state,
                              const Eigen::VectorXd& betas, double log_focal, bool derivatives, FrameSystem* system,
                              FrameResiduals* residuals) {
  const bool moves = data.camera_from_scene != nullptr;
  if (moves) in_camera_ = StateInCamera(layout, *data.camera_from_scene, betas, state);
  sums_.Begin(layout, moves ? in_camera_ : state, betas, log_focal, derivatives, residuals);
  if (derivatives) {
    int rows = 0;
    data.ForEachTerm([&](const auto& term) { rows += term.num_rows(); });
    sums_.ReserveRows(rows);
  }
  data.ForEachTerm([&](const auto& term) { term.Add(&sums_); });
  sums_.Finish(system);
  if (moves && derivatives) TakeToScene(layout, *data.camera_from_scene, system);
}

}  // namespace bodyloom
