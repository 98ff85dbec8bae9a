// SPDX-License-Identifier: Apache-2.0
/// The last prediction of every truncated roll-out of a training run (neural/motion/rollout_plan.h), as the past of its
/// next frame. Internal: includes LibTorch.
#pragma once

#include <cstdint>

#include "bodyloom/neural/motion/motion_batches.h"
#include "bodyloom/neural/motion/motion_model.h"
#include "bodyloom/neural/training/checkpoint.h"

namespace bodyloom {

class RolloutMemory {
 public:
  /// `nothing`: the past of a clip's first frame, 1×…; batches of `places` places with `rollouts` roll-outs each.
  RolloutMemory(MotionState nothing, int places, int rollouts);

  /// As "past_labels", "past_image" and "past_normals".
  void AddTo(Checkpoint* checkpoint);
  /// After a checkpoint was loaded: onto the device. Throws std::invalid_argument when it holds other numbers of
  /// roll-outs.
  void Begin();

  /// The past of every place of a batch, moved to where its window is now, what its box sees of it, B×…: its roll-out's
  /// prediction of the frame before, or, where the roll-out restarts, batch.past or nothing.
  [[nodiscard]] MotionState Before(const MotionBatch& batch) const;
  /// Keeps the prediction of a batch's boxes, detached; outside of them is background.
  void Keep(const MotionBatch& batch, const MotionState& predicted);

 private:
  [[nodiscard]] int64_t PlaceOf(const RolloutStep& step) const { return int64_t{step.rollout} * places_; }

  MotionState nothing_, last_;  ///< last_: (rollouts·B)×…, those of one turn together, whole windows
  int64_t places_, rollouts_;
};

}  // namespace bodyloom
