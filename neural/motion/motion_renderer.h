// SPDX-License-Identifier: Apache-2.0
/// Inference with a trained motion-dependent renderer: from motion to images.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "neural/metrics/lpips.h"
#include "neural/metrics/pixel_metrics.h"
#include "neural/motion/motion_config.h"
#include "neural/motion/motion_frame.h"

namespace bodyloom {

struct MotionRendererOptions {
  int warmup_iterations = 50;  ///< for a clip's first frame, as in Kappel et al., CVPR 2021
  int reach = 0;               ///< of clothes beyond the body, pixels (neural/motion/motion_frame.h); 0: not known
  bool whole_window = false;   ///< pixels beyond reach may still be the person (roll_out.h)
  bool score = false;          ///< compare every frame with its truth
  /// With `score`: also compare whole windows by LPIPS and tLPIPS (unless empty) and SSIM (unless empty).
  std::shared_ptr<const Lpips> lpips = {};
  ImageSimilarity ssim = {};
  int num_threads = 0;         ///< 0: all cores
  std::string device = "cpu";  ///< or "cuda"
};

class MotionRenderer {
 public:
  /// Throws std::runtime_error naming the file when the checkpoint cannot be read or is of another configuration.
  MotionRenderer(const std::string& checkpoint_path, const MotionConfig& config,
                 const MotionRendererOptions& options = {});
  ~MotionRenderer();
  MotionRenderer(const MotionRenderer&) = delete;
  MotionRenderer& operator=(const MotionRenderer&) = delete;

  /// Renders the next frame of the clip. Throws std::invalid_argument when the frame's sizes do not fit, or it is to be
  /// scored and has no image.
  MotionImage Next(const MotionFrame& frame);
  /// Starts another clip with the next frame.
  void Restart();
  /// Renders the next frame as the first of a clip, but scores it as the successor of the last one.
  void ForgetPast();

  /// Scores of all frames so far.
  [[nodiscard]] MotionScores scores() const;
  /// Scores of the last frame.
  [[nodiscard]] MotionFrameScores last_scores() const;

  /// Numbers of frames with the same motion maps (and surface coordinates) as the previous one, whose descriptors
  /// (projections) were reused.
  [[nodiscard]] int64_t descriptors_kept() const;
  [[nodiscard]] int64_t projections_kept() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bodyloom
