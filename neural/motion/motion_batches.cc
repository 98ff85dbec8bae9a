// SPDX-License-Identifier: Apache-2.0
#include "neural/motion/motion_batches.h"

#include <chrono>
#include <span>
#include <utility>

namespace bodyloom {
namespace {

constexpr size_t kAhead = 3;

MotionBatch MakeBatch(const MotionFrameSource& source, const MotionConfig& config, std::vector<ChainStep> steps) {
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
  batch.input = InputOf(batch.frames, config);
  batch.truth = TruthOf(batch.frames, config);
  for (MotionFrame& frame : batch.frames) {
    frame.motion = frame.uv = frame.body = frame.image = frame.normals = {};
    frame.labels = {};
  }
  batch.steps = std::move(steps);
  return batch;
}

}  // namespace

MotionBatches::MotionBatches(const MotionFrameSource& source, const MotionConfig& config, ChainPlan plan, int64_t first,
                             int64_t last)
    : source_(source), config_(config), plan_(std::move(plan)) {
  plan_.Skip(first);
  thread_ = std::thread([this, steps = last - first] { Run(steps); });
}

MotionBatches::~MotionBatches() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

MotionBatch MotionBatches::Take() {
  const auto start = std::chrono::steady_clock::now();
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return !ready_.empty() || error_ != nullptr; });
  waited_s_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (ready_.empty()) std::rethrow_exception(error_);
  MotionBatch batch = std::move(ready_.front());
  ready_.pop_front();
  changed_.notify_all();
  return batch;
}

void MotionBatches::Run(int64_t steps) {
  try {
    for (int64_t i = 0; i < steps; ++i) {
      MotionBatch batch = MakeBatch(source_, config_, plan_.Next());
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return stop_ || ready_.size() < kAhead; });
      if (stop_) return;
      ready_.push_back(std::move(batch));
      changed_.notify_all();
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    error_ = std::current_exception();
    changed_.notify_all();
  }
}

}  // namespace bodyloom
