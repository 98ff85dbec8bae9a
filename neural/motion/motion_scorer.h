// SPDX-License-Identifier: Apache-2.0
/// Scores of a rolled-out clip against the truth. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <memory>
#include <optional>

#include "neural/metrics/pixel_metrics.h"
#include "neural/metrics/temporal_lpips.h"
#include "neural/motion/frame_tensors.h"
#include "neural/motion/motion_frame.h"
#include "neural/motion/motion_model.h"

namespace bodyloom {

/// Of whole windows beside the foreground's scores. Windows below kSmallestSide are not compared by them.
struct WindowScoring {
  static constexpr int kSmallestSide = 32;  ///< pixels, that LPIPS' network takes
  std::shared_ptr<const Lpips> lpips;       ///< empty: neither LPIPS nor tLPIPS
  PictureSimilarity ssim;
};

/// Sums over frames, one at a time in order; windows may move between them.
class MotionScorer {
 public:
  explicit MotionScorer(const MotionConfig& config, const WindowScoring& windows = {});
  /// One frame (B = 1) and where the window of the frame before lies in this one.
  void Add(const MotionState& predicted, const MotionTruth& truth, int before_x, int before_y);
  /// The next frame does not follow the last one.
  void Restart();
  [[nodiscard]] MotionScores Scores() const;
  /// Of the frame added last.
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
