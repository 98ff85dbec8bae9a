// SPDX-License-Identifier: Apache-2.0
#include "neural/motion/roll_out.h"

#include <span>

namespace bodyloom {

using torch::Tensor;

namespace {

bool Same(const Tensor& a, const Tensor& b) { return a.defined() && b.defined() && torch::equal(a, b); }

}  // namespace

void RollOut::Restart() {
  past_ = MotionState();
  last_ = MotionInput();
  descriptor_ = projected_ = Tensor();
}

void RollOut::KeepWithinReach(const Tensor& body, MotionStepResult* result) const {
  if (reach_ <= 0 || body.max().item<float>() <= 0) return;
  const Tensor near = torch::max_pool2d(body, 2 * reach_ + 1, 1, reach_);
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
  const MotionInput input = InputOf(std::span(&frame, 1), model_->config);
  const bool same_motion = !model_->config.motion || Same(input.motion, last_.motion);
  const bool same_surface = Same(input.uv, last_.uv) && Same(input.body, last_.body);
  if (model_->config.motion && !same_motion) descriptor_ = model_->Encode(input.motion);
  if (!same_motion || !same_surface) projected_ = model_->Project(descriptor_, input.uv, input.body);
  descriptors_kept_ += model_->config.motion && same_motion;
  projections_kept_ += same_motion && same_surface;
  last_ = input;
  int passes = 1;
  if (past_.image.defined()) {
    for (Tensor* part : past_.Parts()) *part = Shifted(*part, frame.before_x, frame.before_y);
  } else {
    past_ = model_->Nothing(1, frame.height, frame.width);
    passes += warmup_;
  }
  MotionStepResult result;
  for (int i = 0; i < passes; ++i) {
    result = model_->Decode(projected_, past_);
    KeepWithinReach(input.body, &result);
    past_ = result.state;
  }
  return result;
}

}  // namespace bodyloom
