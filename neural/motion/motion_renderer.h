// SPDX-License-Identifier: Apache-2.0
/// A trained motion-dependent renderer at work: motion in, pictures out.
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
  int warmup_iterations = 50;  ///< of a clip's first frame, as Kappel et al., CVPR 2021
  int reach = 0;               ///< of clothes beyond the body, pixels (neural/motion/motion_frame.h); 0: not known
  bool anywhere = false;       ///< what lies beyond reach may still be the person (roll_out.h)
  bool score = false;          ///< compare every frame with the truth that it holds
  /// With `score`: whole windows too, by LPIPS and tLPIPS (empty: not) and SSIM (empty: not).
  std::shared_ptr<const Lpips> lpips = {};
  PictureSimilarity ssim = {};
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

  /// The next frame of the clip. Throws std::invalid_argument when the frame's sizes do not fit, or it is to be
  /// compared and has no image.
  MotionPicture Next(const MotionFrame& frame);
  /// The next frame begins another clip.
  void Restart();
  /// The next frame is rendered as if it began another clip, but is still compared as the one that follows.
  void ForgetPast();

  /// Of all frames compared so far.
  [[nodiscard]] MotionScores scores() const;
  /// Of the last frame compared.
  [[nodiscard]] MotionFrameScores last_scores() const;

  /// Frames whose motion maps (and surface coordinates) were those of the frame before: their descriptors
  /// (projections) were not computed again.
  [[nodiscard]] int64_t descriptors_kept() const;
  [[nodiscard]] int64_t projections_kept() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bodyloom
