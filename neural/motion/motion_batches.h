// SPDX-License-Identifier: Apache-2.0
/// The batches of a training run, prefetched by a thread of their own. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "geometry/base/prefetcher.h"
#include "neural/motion/frame_tensors.h"
#include "neural/motion/person_box.h"
#include "neural/motion/rollout_plan.h"

namespace bodyloom {

struct MotionBatch {
  std::vector<RolloutStep> steps;
  std::vector<MotionFrame> frames;  ///< only their windows' places are left
  std::vector<PixelBox> boxes;      ///< what the networks see of each window
  MotionInput input;                ///< of the boxes
  MotionTruth truth;                ///< of the boxes
  std::vector<MotionState> past;  ///< whole windows of the roll-outs that restart from truth: 1×…; else without parts
};

/// Steps first, first + 1, … last − 1 of a plan. `reach`: of clothes, pixels (config.around_body).
class MotionBatches {
 public:
  MotionBatches(const MotionFrameSource& source, const MotionConfig& config, int reach, RolloutPlan plan, int64_t first,
                int64_t last);

  /// The next batch; waits for it. Throws what the source threw.
  MotionBatch Take() { return ahead_.Take(); }
  [[nodiscard]] double waited_s() const { return ahead_.waited_s(); }

 private:
  RolloutPlan plan_;
  Prefetcher<MotionBatch> ahead_;
};

}  // namespace bodyloom
