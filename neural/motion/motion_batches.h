// SPDX-License-Identifier: Apache-2.0
/// Batches of a training run, prefetched by a separate thread. Internal: includes LibTorch.
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
  std::vector<MotionFrame> frames;  ///< without images and maps, only the positions of their windows
  std::vector<PixelBox> boxes;      ///< part of each window that the networks see
  MotionInput input;                ///< of the boxes
  MotionTruth truth;                ///< of the boxes
  std::vector<MotionState> past;  ///< whole windows, 1×…, for roll-outs that restart from truth; else without parts
};

/// Batches of steps first … last − 1 of a plan. `reach`: of clothes, pixels (for config.around_body).
class MotionBatches {
 public:
  MotionBatches(const MotionFrameSource& source, const MotionConfig& config, int reach, RolloutPlan plan, int64_t first,
                int64_t last);

  /// Waits for the next batch and returns it. Throws what the source threw.
  MotionBatch Take() { return ahead_.Take(); }
  [[nodiscard]] double waited_s() const { return ahead_.waited_s(); }

 private:
  RolloutPlan plan_;
  Prefetcher<MotionBatch> ahead_;
};

}  // namespace bodyloom
