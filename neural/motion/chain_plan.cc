// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/motion/chain_plan.h"

#include <algorithm>
#include <utility>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/split_mix.h"

namespace bodyloom {

ChainPlan::ChainPlan(std::vector<FrameRange> ranges, const Options& options)
    : ranges_(std::move(ranges)), options_(options) {
  BODYLOOM_CHECK(options.chains > 0 && options.walks > 0 && options.length > 0, "chain plan: ", options.chains,
                 " chains of ", options.walks, " walks of ", options.length, " frames, expected at least one of each");
  walks_.resize(static_cast<size_t>(options.chains) * options.walks);
  int64_t sum = 0;
  for (const FrameRange& range : ranges_) {
    BODYLOOM_CHECK(range.begin >= 0 && range.end > range.begin, "chain plan: frames ", range.begin, " to ", range.end,
                   ", expected at least one");
    frames_up_to_.push_back(sum += range.end - range.begin);
  }
  BODYLOOM_CHECK(sum > 0, "chain plan: no frames");
}

std::vector<ChainStep> ChainPlan::Next() {
  std::vector<ChainStep> steps;
  const auto turn = static_cast<int>(step_ % options_.walks);
  for (int c = 0; c < options_.chains; ++c) {
    const size_t place = static_cast<size_t>(turn) * options_.chains + c;
    Walk& walk = walks_[place];
    ChainStep step;
    step.walk = turn;
    if (walk.left == 0 || walk.frame >= walk.end) {
      const uint64_t hash = Mix(Mix(Mix(options_.seed) ^ static_cast<uint64_t>(step_)) ^ place);
      const auto at = static_cast<int64_t>(UniformOf(hash) * static_cast<double>(frames_up_to_.back()));
      const size_t r = std::upper_bound(frames_up_to_.begin(), frames_up_to_.end(), at) - frames_up_to_.begin();
      const FrameRange& range = ranges_[std::min(r, ranges_.size() - 1)];
      walk.frame = range.end - static_cast<int>(frames_up_to_[r] - at);
      walk.end = range.end;
      const bool first = step_ < options_.walks;
      walk.left = first ? std::max(1, options_.length * (options_.walks - turn) / options_.walks) : options_.length;
      step.restart = true;
      step.from_truth = walk.frame > range.begin && UniformOf(Mix(hash)) < options_.from_truth;
    }
    step.frame = walk.frame++;
    --walk.left;
    steps.push_back(step);
  }
  ++step_;
  return steps;
}

void ChainPlan::Skip(int64_t steps) {
  for (int64_t i = 0; i < steps; ++i) Next();
}

}  // namespace bodyloom
