// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/motion/rollout_memory.h"

#include <utility>
#include <vector>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/neural/device.h"
#include "bodyloom/neural/image_tensor.h"
#include "bodyloom/neural/motion/person_box.h"

namespace bodyloom {

using torch::Tensor;

RolloutMemory::RolloutMemory(MotionState nothing, int places, int rollouts)
    : nothing_(std::move(nothing)), last_(nothing_), places_(places), rollouts_(rollouts) {
  for (Tensor* part : last_.Parts()) *part = part->repeat({rollouts_ * places_, 1, 1, 1});
}

void RolloutMemory::AddTo(Checkpoint* checkpoint) {
  checkpoint->Add("past_labels", &last_.labels);
  checkpoint->Add("past_image", &last_.image);
  checkpoint->Add("past_normals", &last_.normals);
}

void RolloutMemory::Begin() {
  BODYLOOM_CHECK(last_.image.size(0) == rollouts_ * places_, "motion training: the checkpoint holds ",
                 last_.image.size(0), " roll-outs, expected ", rollouts_ * places_,
                 ": go on with the batch and the roll-outs (--rollouts) that the run began with");
  for (Tensor* part : last_.Parts()) *part = OnDevice(*part);
}

MotionState RolloutMemory::Before(const MotionBatch& batch) const {
  std::vector<MotionState> each;
  for (size_t c = 0; c < batch.steps.size(); ++c) {
    const RolloutStep& step = batch.steps[c];
    MotionState state = nothing_;
    if (!step.restart) {
      state = last_;
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

void RolloutMemory::Keep(const MotionBatch& batch, const MotionState& predicted) {
  const torch::NoGradGuard no_grad;
  const int64_t height = last_.image.size(2), width = last_.image.size(3);
  for (int64_t c = 0; c < places_; ++c) {
    MotionState one = predicted;
    for (Tensor* part : one.Parts()) *part = part->slice(0, c, c + 1);
    const MotionState whole = OnWindow(one, batch.boxes[c], height, width);
    const int64_t at = PlaceOf(batch.steps[c]) + c;
    for (Tensor MotionState::*part : {&MotionState::labels, &MotionState::image, &MotionState::normals}) {
      if ((last_.*part).defined()) (last_.*part).slice(0, at, at + 1).copy_(whole.*part);
    }
  }
}

}  // namespace bodyloom
