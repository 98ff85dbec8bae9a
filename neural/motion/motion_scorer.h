// SPDX-License-Identifier: Apache-2.0
/// Scores of a rolled-out clip against the truth. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <limits>

#include "bodyloom/neural/metrics/class_overlap.h"
#include "bodyloom/neural/motion/frame_tensors.h"
#include "bodyloom/neural/motion/motion_model.h"
#include "bodyloom/neural/motion/motion_scores.h"

namespace bodyloom {

/// Sums over frames, one at a time in order; windows may move between them.
class MotionScorer {
 public:
  explicit MotionScorer(const MotionConfig& config) : config_(config) {}
  /// One frame (B = 1) and where the window of the frame before lies in this one.
  void Add(const MotionState& predicted, const MotionTruth& truth, int before_x, int before_y);
  /// The next frame does not follow the last one.
  void Restart() { last_error_ = torch::Tensor(); }
  [[nodiscard]] MotionScores Scores() const;
  /// image_l1 of the frame added last; NaN before.
  [[nodiscard]] double last_l1() const { return last_l1_; }

 private:
  const MotionConfig& config_;
  double l1_ = 0, squared_ = 0, angle_deg_ = 0, flicker_ = 0;
  double foreground_ = 0, foreground_with_normals_ = 0, foreground_with_past_ = 0;  ///< pixels
  ClassOverlap overlap_{0};  ///< without classes until labels were compared
  torch::Tensor last_error_;
  double last_l1_ = std::numeric_limits<double>::quiet_NaN();
  int frames_ = 0;
};

}  // namespace bodyloom
