// SPDX-License-Identifier: Apache-2.0
/// A clip rendered frame after frame from nothing but its motion. Internal: includes LibTorch.
#pragma once

#include <cstdint>

#include "neural/motion/frame_tensors.h"
#include "neural/motion/motion_batches.h"
#include "neural/motion/motion_model.h"
#include "neural/training/checkpoint.h"

namespace bodyloom {

/// How far clothes reach beyond the body, pixels along x or y; 0: not known.
struct Reach {
  int pixels = 0;
  /// Even so may the person be anywhere in what the networks look at; otherwise what lies beyond reach is background:
  /// the recurrence would keep a speck alive that it once put there.
  bool anywhere = false;
};

/// Keeps the past. What does not change from one frame to the next is not computed again: the descriptor of the same
/// motion maps, and its projection by the same surface coordinates; both exact.
class RollOut {
 public:
  /// The first frame passes `warmup_iterations` times through the network before it counts, each time with its own last
  /// answer as its past. Throws std::invalid_argument when the networks look around the body (config.around_body) and
  /// it is not known how far.
  RollOut(MotionModel model, int warmup_iterations, Reach reach = {});

  /// The next frame, its whole window: state and foreground (the rest is for training and undefined). No gradients.
  MotionStepResult Next(const MotionFrame& frame);
  /// The next frame is the first of another clip.
  void Restart();

  [[nodiscard]] int64_t descriptors_kept() const { return descriptors_kept_; }
  [[nodiscard]] int64_t projections_kept() const { return projections_kept_; }

 private:
  void KeepWithinReach(const torch::Tensor& body, MotionStepResult* result) const;

  MotionModel model_;
  int warmup_;
  Reach reach_;
  MotionState past_;  ///< whole window
  MotionInput last_;
  torch::Tensor descriptor_, projected_;
  int64_t descriptors_kept_ = 0, projections_kept_ = 0;
};

// The last prediction of every truncated roll-out of a training run (neural/motion/rollout_plan.h), as the past of its
// next frame. Internal: includes LibTorch.

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
