// SPDX-License-Identifier: Apache-2.0
/// The batches of a training run, made by a thread of their own a few steps ahead. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "neural/motion/chain_plan.h"
#include "neural/motion/frame_tensors.h"

namespace bodyloom {

struct MotionBatch {
  std::vector<ChainStep> steps;
  std::vector<MotionFrame> frames;  ///< only their windows' places are left
  MotionInput input;
  MotionTruth truth;
  std::vector<MotionState> past;  ///< of the chains that restart from truth: 1×…; else without parts
};

/// Steps first, first + 1, … last − 1 of a plan.
class MotionBatches {
 public:
  MotionBatches(const MotionFrameSource& source, const MotionConfig& config, ChainPlan plan, int64_t first,
                int64_t last);
  ~MotionBatches();
  MotionBatches(const MotionBatches&) = delete;
  MotionBatches& operator=(const MotionBatches&) = delete;

  /// The next batch; waits for it. Throws what the source threw. Adds the time it waited to waited_s().
  MotionBatch Take();
  [[nodiscard]] double waited_s() const { return waited_s_; }

 private:
  void Run(int64_t steps);

  const MotionFrameSource& source_;
  const MotionConfig& config_;
  ChainPlan plan_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<MotionBatch> ready_;
  std::exception_ptr error_;
  bool stop_ = false;
  double waited_s_ = 0;
  std::thread thread_;
};

}  // namespace bodyloom
