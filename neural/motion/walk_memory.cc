// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/motion/walk_memory.h"

#include <utility>
#include <vector>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/neural/device.h"
#include "bodyloom/neural/motion/person_box.h"

namespace bodyloom {

using torch::Tensor;

WalkMemory::WalkMemory(MotionState nothing, int chains, int walks)
    : nothing_(std::move(nothing)), said_(nothing_), chains_(chains), walks_(walks) {
  for (Tensor* part : said_.Parts()) *part = part->repeat({walks_ * chains_, 1, 1, 1});
}

void WalkMemory::AddTo(Checkpoint* checkpoint) {
  checkpoint->Add("past_labels", &said_.labels);
  checkpoint->Add("past_image", &said_.image);
  checkpoint->Add("past_normals", &said_.normals);
}

void WalkMemory::Begin() {
  BODYLOOM_CHECK(said_.image.size(0) == walks_ * chains_, "motion training: the checkpoint holds ", said_.image.size(0),
                 " walks, expected ", walks_ * chains_, ": go on with the batch and walks that the run began with");
  for (Tensor* part : said_.Parts()) *part = OnDevice(*part);
}

MotionState WalkMemory::Before(const MotionBatch& batch) const {
  std::vector<MotionState> each;
  for (size_t c = 0; c < batch.steps.size(); ++c) {
    const ChainStep& step = batch.steps[c];
    MotionState state = nothing_;
    if (!step.restart) {
      state = said_;
      const int64_t at = PlaceOf(step) + static_cast<int64_t>(c);
      for (Tensor* part : state.Parts()) *part = part->slice(0, at, at + 1);
    } else if (step.from_truth) {
      state = batch.past[c];
    }
    for (Tensor* part : state.Parts()) *part = Shifted(*part, batch.frames[c].before_x, batch.frames[c].before_y);
    each.push_back(Within(state, batch.boxes[c]));
  }
  const auto join = [&](Tensor MotionState::*part) {
    std::vector<Tensor> tensors;
    for (const MotionState& state : each) {
      if ((state.*part).defined()) tensors.push_back(state.*part);
    }
    return tensors.empty() ? Tensor() : torch::cat(tensors, 0);
  };
  return {join(&MotionState::labels), join(&MotionState::image), join(&MotionState::normals)};
}

void WalkMemory::Keep(const MotionBatch& batch, const MotionState& said) {
  const torch::NoGradGuard no_grad;
  const int64_t height = said_.image.size(2), width = said_.image.size(3);
  for (int64_t c = 0; c < chains_; ++c) {
    MotionState one = said;
    for (Tensor* part : one.Parts()) *part = part->slice(0, c, c + 1);
    const MotionState whole = OnWindow(one, batch.boxes[c], height, width);
    const int64_t at = PlaceOf(batch.steps[c]) + c;
    for (Tensor MotionState::*part : {&MotionState::labels, &MotionState::image, &MotionState::normals}) {
      if ((said_.*part).defined()) (said_.*part).slice(0, at, at + 1).copy_(whole.*part);
    }
  }
}

}  // namespace bodyloom
