// SPDX-License-Identifier: Apache-2.0
/// What every walk of a training run (neural/motion/chain_plan.h) said last, as the past of its next frame. Internal:
/// includes LibTorch.
#pragma once

#include <cstdint>

#include "bodyloom/neural/motion/motion_batches.h"
#include "bodyloom/neural/motion/motion_model.h"
#include "bodyloom/neural/training/checkpoint.h"

namespace bodyloom {

class WalkMemory {
 public:
  /// `nothing`: the past of a clip's first frame, 1×…; batches of `chains` places with `walks` walks each.
  WalkMemory(MotionState nothing, int chains, int walks);

  /// As "past_labels", "past_image" and "past_normals".
  void AddTo(Checkpoint* checkpoint);
  /// After a checkpoint was loaded: onto the device. Throws std::invalid_argument when it holds other numbers of walks.
  void Begin();

  /// The past of every place of a batch, moved to where its window is now, what its box sees of it, B×…: what its walk
  /// said of the frame before, or, where the walk starts anew, batch.past or nothing.
  [[nodiscard]] MotionState Before(const MotionBatch& batch) const;
  /// Keeps what was said of a batch's boxes, detached; outside of them is background.
  void Keep(const MotionBatch& batch, const MotionState& said);

 private:
  [[nodiscard]] int64_t PlaceOf(const ChainStep& step) const { return int64_t{step.walk} * chains_; }

  MotionState nothing_, said_;  ///< said_: (walks·B)×…, those of one turn together, whole windows
  int64_t chains_, walks_;
};

}  // namespace bodyloom
