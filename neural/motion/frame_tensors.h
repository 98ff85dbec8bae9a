// SPDX-License-Identifier: Apache-2.0
/// Converts frames to tensors. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <span>
#include <vector>

#include "neural/motion/motion_frame.h"
#include "neural/motion/motion_model.h"

namespace bodyloom {

/// Converts frames of one size. Throws std::invalid_argument when a frame lacks what the configuration needs, naming
/// it.
MotionInput InputOf(std::span<const MotionFrame> frames, const MotionConfig& config);

struct MotionTruth {
  torch::Tensor image;       ///< B×3×h×w
  torch::Tensor labels;      ///< B×K×h×w one-hot; undefined when the frames have none
  torch::Tensor normals;     ///< B×3×h×w; undefined when the frames have none
  torch::Tensor foreground;  ///< B×1×h×w: labels other than 0, else where the image is not black
  /// The truth as the past of a following frame; missing parts are zero.
  [[nodiscard]] MotionState State(const MotionConfig& config) const;
};

/// Parts are defined only if all frames have them. Throws std::invalid_argument when images are missing, sizes differ
/// or a label is beyond the configuration's classes.
MotionTruth TruthOf(std::span<const MotionFrame> frames, const MotionConfig& config);

}  // namespace bodyloom
