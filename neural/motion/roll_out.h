// SPDX-License-Identifier: Apache-2.0
/// A clip rendered frame after frame from nothing but its motion. Internal: includes LibTorch.
#pragma once

#include "neural/motion/frame_tensors.h"
#include "neural/motion/motion_model.h"

namespace bodyloom {

/// Keeps the past. What does not change from one frame to the next is not computed again: the descriptor of the same
/// motion maps, and its projection by the same surface coordinates; both exact.
class RollOut {
 public:
  /// The first frame passes `warmup_iterations` times through the network before it counts, each time with its own last
  /// answer as its past. What lies more than `reach` pixels (along x or y) from the body is background: the recurrence
  /// would keep a speck alive that it once put there; 0: anything may be anywhere.
  RollOut(MotionModel model, int warmup_iterations, int reach = 0)
      : model_(std::move(model)), warmup_(warmup_iterations), reach_(reach) {}

  /// The next frame. No gradients.
  MotionStepResult Next(const MotionFrame& frame);
  /// The next frame is the first of another clip.
  void Restart();

  [[nodiscard]] int64_t descriptors_kept() const { return descriptors_kept_; }
  [[nodiscard]] int64_t projections_kept() const { return projections_kept_; }

 private:
  void KeepWithinReach(const torch::Tensor& body, MotionStepResult* result) const;

  MotionModel model_;
  int warmup_, reach_;
  MotionState past_;
  MotionInput last_;
  torch::Tensor descriptor_, projected_;
  int64_t descriptors_kept_ = 0, projections_kept_ = 0;
};

}  // namespace bodyloom
