// SPDX-License-Identifier: Apache-2.0
/// Trains the motion-dependent renderer on one person's clip.
///
///   L = L_a + 10 L_s + L_n + L_p + 0.01 L_g            (Yoon et al., CVPR 2022, eq. 9 and below)
/// L_a, L_n: mean absolute differences of image and normals; L_s: cross entropy of the classes, or the mean absolute
/// difference of probabilities (the paper does not specify the norm; with absolute differences small classes are never
/// learned, docs/lab/motion_renderer.md); L_p: of VGG-16's features after conv 1-2, 2-2, 3-2 and 4-2; L_g: the loss of
/// a patch discriminator on the image, conditioned on the true classes. L_a, L_p and L_g use the colour masked by the
/// true foreground (not in the paper: docs/lab/motion_renderer.md). Losses without truth in the clip are disabled
/// (listed in `losses_off`). Recurrence: neural/motion/rollout_plan.h.
///
/// Writes into run_dir: checkpoint.bin and metrics.csv. A run resumed from a checkpoint ends with the same bytes as an
/// uninterrupted one (same binary, machine and threads).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "neural/metrics/pixel_metrics.h"
#include "neural/motion/motion_config.h"
#include "neural/motion/motion_frame.h"
#include "neural/motion/rollout_plan.h"
#include "neural/networks/named_weights.h"
#include "neural/training/training_run.h"

namespace bodyloom {

/// One validated frame with its truth: planar RGB in [0, 1], window size.
struct MotionPreview {
  int frame = 0, width = 0, height = 0;
  std::vector<float> image, normals, true_image, true_normals;  ///< normals may be empty
  std::vector<uint8_t> labels, true_labels;
};

struct TrainMotionOptions : TrainingRun {
  MotionConfig config;
  std::vector<FrameRange> train, validation;  ///< validation may be empty
  MotionFrameSource validation_source;        ///< of another clip; empty: the same clip
  int batch = 4;
  int rollout_length = 32;
  int reach = 0;      ///< of clothes beyond the body, pixels; needed with config.around_body
  int rollouts = 16;  ///< per place of the batch (neural/motion/rollout_plan.h)
  double learning_rate = 1e-3, discriminator_rate = 2e-4;
  bool shape_by_cross_entropy = true;
  double shape_weight = 10, normal_weight = 1, perceptual_weight = 1, gan_weight = 0.01;
  /// Mean age, as a share of the steps, of the averaged weights that are validated and kept
  /// (neural/training/optimizers.h); 0: the last step's weights.
  double average = 0.1;
  int warmup_iterations = 10;        ///< for the first frame of a roll-out
  WeightsFrom vgg16;                 ///< empty: a seeded random-feature substitute
  WeightsFrom alexnet, lpips_heads;  ///< for validation's LPIPS; either empty: a random-feature substitute
  ImageSimilarity ssim;              ///< of validation
  int preview_frames = 4;
  std::function<void(int step, const std::vector<MotionPreview>&)> preview;
  [[nodiscard]] bool IsValid(std::string* why) const;
};

struct TrainMotionSummary : RendererTraining {
  MotionScores scores;
};

/// Throws std::invalid_argument for options that are not valid, std::runtime_error for files that cannot be used.
TrainMotionSummary TrainMotion(const MotionFrameSource& source, const TrainMotionOptions& options);

}  // namespace bodyloom
