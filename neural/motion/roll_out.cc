// SPDX-License-Identifier: Apache-2.0
#include "neural/motion/roll_out.h"

#include <span>
#include <utility>

#include "geometry/base/check.h"
#include "neural/base/device.h"
#include "neural/base/image_tensor.h"

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

using torch::Tensor;

bool Same(const Tensor& a, const Tensor& b) { return a.defined() && b.defined() && torch::equal(a, b); }

}  // namespace

MotionBatches::MotionBatches(const MotionFrameSource& source, const MotionConfig& config, int reach, RolloutPlan plan,
                             int64_t first, int64_t last)
    : plan_((plan.Skip(first), std::move(plan))), ahead_(last - first, [this, &source, &config, reach](int64_t) {
        return MakeBatch(source, config, reach, plan_.Next());
      }) {}

RollOut::RollOut(MotionModel model, int warmup_iterations, Reach reach)
    : model_(std::move(model)), warmup_(warmup_iterations), reach_(reach) {
  BODYLOOM_CHECK(!model_->config.around_body || reach_.pixels > 0, "motion renderer: a reach of ", reach_.pixels,
                 " px, expected at least 1 for networks that look around the body");
}

void RollOut::Restart() {
  past_ = MotionState();
  last_ = MotionInput();
  descriptor_ = projected_ = Tensor();
}

void RollOut::KeepWithinReach(const Tensor& body, MotionStepResult* result) const {
  if (reach_.whole_window || reach_.pixels <= 0 || body.max().item<float>() <= 0) return;
  const Tensor near = torch::max_pool2d(body, 2 * reach_.pixels + 1, 1, reach_.pixels);
  MotionState& state = result->state;
  state.image = state.image * near;
  if (state.normals.defined()) state.normals = state.normals * near;
  if (state.labels.defined()) {
    Tensor background = torch::zeros_like(state.labels);
    background.slice(1, 0, 1).fill_(1);
    state.labels = torch::where(near > 0, state.labels, background);
    result->foreground = result->foreground * near;
  }
}

MotionStepResult RollOut::Next(const MotionFrame& frame) {
  const torch::NoGradGuard no_grad;
  const MotionConfig& config = model_->config;
  const PixelBox box =
      PersonBoxes(std::span(&frame, 1), config.around_body ? reach_.pixels : 0, config.Multiple()).front();
  const MotionFrame seen = Within(frame, box);
  const MotionInput input = InputOf(std::span(&seen, 1), config);
  const bool same_motion = !config.motion || Same(input.motion, last_.motion);
  const bool same_surface = Same(input.uv, last_.uv) && Same(input.body, last_.body);
  if (config.motion && !same_motion) descriptor_ = model_->Encode(input.motion);
  if (!same_motion || !same_surface) projected_ = model_->Project(descriptor_, input.uv, input.body);
  descriptors_kept_ += config.motion && same_motion;
  projections_kept_ += same_motion && same_surface;
  last_ = input;
  int passes = 1;
  if (past_.image.defined()) {
    for (Tensor* part : past_.Parts()) *part = Shifted(*part, frame.before_x, frame.before_y);
  } else {
    past_ = model_->InitialState(1, frame.height, frame.width);
    passes += warmup_;
  }
  MotionState past = Within(past_, box);
  MotionStepResult result;
  for (int i = 0; i < passes; ++i) {
    result = model_->Decode(projected_, past);
    KeepWithinReach(input.body, &result);
    past = result.state;
  }
  past_ = result.state = OnWindow(result.state, box, frame.height, frame.width);
  result.foreground = OnWindow(result.foreground, box, frame.height, frame.width);
  result.label_logits = result.colour = Tensor();
  return result;
}

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
