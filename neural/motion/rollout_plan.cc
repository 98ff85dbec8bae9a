// SPDX-License-Identifier: Apache-2.0
#include "neural/motion/rollout_plan.h"

#include <algorithm>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"

namespace bodyloom {

RolloutPlan::RolloutPlan(std::vector<FrameRange> ranges, const Options& options)
    : ranges_(std::move(ranges)), options_(options) {
  BODYLOOM_CHECK(options.places > 0 && options.rollouts > 0 && options.length > 0, "roll-out plan: ", options.places,
                 " places of ", options.rollouts, " roll-outs of ", options.length,
                 " frames, expected at least one of each");
  rollouts_.resize(static_cast<size_t>(options.places) * options.rollouts);
  int64_t sum = 0;
  for (const FrameRange& range : ranges_) {
    BODYLOOM_CHECK(range.begin >= 0 && range.end > range.begin, "roll-out plan: frames ", range.begin, " to ",
                   range.end, ", expected at least one");
    frames_up_to_.push_back(sum += range.end - range.begin);
  }
  BODYLOOM_CHECK(sum > 0, "roll-out plan: no frames");
}

std::vector<RolloutStep> RolloutPlan::Next() {
  std::vector<RolloutStep> steps;
  const auto turn = static_cast<int>(step_ % options_.rollouts);
  for (int c = 0; c < options_.places; ++c) {
    const size_t place = static_cast<size_t>(turn) * options_.places + c;
    Rollout& rollout = rollouts_[place];
    RolloutStep step;
    step.rollout = turn;
    if (rollout.left == 0 || rollout.frame >= rollout.end) {
      const uint64_t hash = Mix(Mix(Mix(options_.seed) ^ static_cast<uint64_t>(step_)) ^ place);
      const auto at = static_cast<int64_t>(UniformOf(hash) * static_cast<double>(frames_up_to_.back()));
      const size_t r = std::upper_bound(frames_up_to_.begin(), frames_up_to_.end(), at) - frames_up_to_.begin();
      const FrameRange& range = ranges_[std::min(r, ranges_.size() - 1)];
      rollout.frame = range.end - static_cast<int>(frames_up_to_[r] - at);
      rollout.end = range.end;
      const bool first = step_ < options_.rollouts;
      rollout.left =
          first ? std::max(1, options_.length * (options_.rollouts - turn) / options_.rollouts) : options_.length;
      step.restart = true;
      step.from_truth = rollout.frame > range.begin && UniformOf(Mix(hash)) < options_.from_truth;
    }
    step.frame = rollout.frame++;
    --rollout.left;
    steps.push_back(step);
  }
  ++step_;
  return steps;
}

void RolloutPlan::Skip(int64_t steps) {
  for (int64_t i = 0; i < steps; ++i) Next();
}

}  // namespace bodyloom
