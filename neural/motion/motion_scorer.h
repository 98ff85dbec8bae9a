// SPDX-License-Identifier: Apache-2.0
/// Scores a rolled-out clip against the truth. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <memory>
#include <optional>

#include "neural/metrics/lpips.h"
#include "neural/metrics/pixel_metrics.h"
#include "neural/motion/frame_tensors.h"
#include "neural/motion/motion_frame.h"
#include "neural/motion/motion_model.h"

namespace bodyloom {

/// Metrics of whole windows, in addition to those of the foreground. Not computed for windows below kSmallestSide.
struct WindowScoring {
  static constexpr int kSmallestSide = 32;  ///< pixels, required by LPIPS' network
  std::shared_ptr<const Lpips> lpips;       ///< empty: neither LPIPS nor tLPIPS
  ImageSimilarity ssim;
};

/// Accumulates scores over frames in order; windows may move between them.
class MotionScorer {
 public:
  explicit MotionScorer(const MotionConfig& config, const WindowScoring& windows = {});
  /// Adds one frame (B = 1); (before_x, before_y) is the position of the previous window in this one.
  void Add(const MotionState& predicted, const MotionTruth& truth, int before_x, int before_y);
  /// Starts a new sequence with the next frame.
  void Restart();
  [[nodiscard]] MotionScores Scores() const;
  /// Scores of the frame added last.
  [[nodiscard]] const MotionFrameScores& last() const { return last_; }

 private:
  void CompareWindows(const torch::Tensor& predicted, const torch::Tensor& truth, int before_x, int before_y);

  const MotionConfig& config_;
  WindowScoring windows_;
  std::optional<TemporalLpips> temporal_;
  double ssim_ = 0;
  int windows_compared_ = 0;
  double l1_ = 0, squared_ = 0, angle_deg_ = 0, flicker_ = 0;
  double foreground_ = 0, foreground_with_normals_ = 0, foreground_with_past_ = 0;  ///< pixels
  ClassOverlap overlap_{0};  ///< without classes until labels were compared
  torch::Tensor last_error_;
  MotionFrameScores last_;
  int frames_ = 0;
};

}  // namespace bodyloom
