// SPDX-License-Identifier: Apache-2.0
/// The batches of a training run, made by a thread of their own a few steps ahead. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "bodyloom/neural/motion/chain_plan.h"
#include "bodyloom/neural/motion/frame_tensors.h"
#include "bodyloom/neural/motion/person_box.h"
#include "bodyloom/geometry/base/prefetcher.h"

namespace bodyloom {

struct MotionBatch {
  std::vector<ChainStep> steps;
  std::vector<MotionFrame> frames;  ///< only their windows' places are left
  std::vector<PixelBox> boxes;      ///< what the networks see of each window
  MotionInput input;                ///< of the boxes
  MotionTruth truth;                ///< of the boxes
  std::vector<MotionState> past;    ///< whole windows of the chains that restart from truth: 1×…; else without parts
};

/// Steps first, first + 1, … last − 1 of a plan. `reach`: of clothes, pixels (config.around_body).
class MotionBatches {
 public:
  MotionBatches(const MotionFrameSource& source, const MotionConfig& config, int reach, ChainPlan plan, int64_t first,
                int64_t last);

  /// The next batch; waits for it. Throws what the source threw.
  MotionBatch Take() { return ahead_.Take(); }
  [[nodiscard]] double waited_s() const { return ahead_.waited_s(); }

 private:
  ChainPlan plan_;
  Prefetcher<MotionBatch> ahead_;
};

}  // namespace bodyloom
