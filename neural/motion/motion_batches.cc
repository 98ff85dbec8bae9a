// SPDX-License-Identifier: Apache-2.0
#include "neural/motion/motion_batches.h"

#include <span>
#include <utility>

namespace bodyloom {
namespace {

MotionBatch MakeBatch(const MotionFrameSource& source, const MotionConfig& config, int reach,
                      std::vector<RolloutStep> steps) {
  MotionBatch batch;
  batch.frames.resize(steps.size());
  batch.past.resize(steps.size());
  for (size_t c = 0; c < steps.size(); ++c) {
    source(steps[c].frame, true, &batch.frames[c]);
    if (!steps[c].from_truth) continue;
    MotionFrame before;
    source(steps[c].frame - 1, true, &before);
    batch.past[c] = TruthOf(std::span(&before, 1), config).State(config);
  }
  batch.boxes = PersonBoxes(batch.frames, config.around_body ? reach : 0, config.Multiple());
  for (size_t c = 0; c < steps.size(); ++c) batch.frames[c] = Within(std::move(batch.frames[c]), batch.boxes[c]);
  batch.input = InputOf(batch.frames, config);
  batch.truth = TruthOf(batch.frames, config);
  for (MotionFrame& frame : batch.frames) {
    frame.motion = frame.dense = frame.uv = frame.body = frame.image = frame.normals = {};
    frame.labels = {};
  }
  batch.steps = std::move(steps);
  return batch;
}

}  // namespace

MotionBatches::MotionBatches(const MotionFrameSource& source, const MotionConfig& config, int reach, RolloutPlan plan,
                             int64_t first, int64_t last)
    : plan_((plan.Skip(first), std::move(plan))), ahead_(last - first, [this, &source, &config, reach](int64_t) {
        return MakeBatch(source, config, reach, plan_.Next());
      }) {}

}  // namespace bodyloom
