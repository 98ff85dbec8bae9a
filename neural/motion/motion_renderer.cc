// SPDX-License-Identifier: Apache-2.0
#include "neural/motion/motion_renderer.h"

#include <span>

#include "neural/motion/frame_tensors.h"
#include "neural/motion/motion_scores.h"
#include "neural/motion/roll_out.h"
#include "neural/motion/score_motion.h"
#include "neural/runtime.h"
#include "neural/training/checkpoint.h"

namespace bodyloom {

using torch::Tensor;

namespace {

MotionModel Loaded(const std::string& path, const MotionConfig& config, const MotionRendererOptions& options) {
  StartNeuralRuntime(options.num_threads);
  MotionModel model(config);
  Checkpoint checkpoint(ToText(config));
  checkpoint.Add("model", model.ptr().get());
  checkpoint.Load(path, CheckpointPart::kModules);
  model->eval();
  return model;
}

}  // namespace

class MotionRenderer::Impl {
 public:
  Impl(const std::string& path, const MotionConfig& config, const MotionRendererOptions& options)
      : roll_(Loaded(path, config, options), options.warmup_iterations, options.reach) {}

  MotionPicture Next(const MotionFrame& frame) {
    const MotionStepResult result = roll_.Next(frame);
    MotionPicture picture;
    picture.width = frame.width;
    picture.height = frame.height;
    const auto values = [](const Tensor& tensor) {
      const Tensor whole = tensor.contiguous();
      return std::vector<float>(whole.data_ptr<float>(), whole.data_ptr<float>() + whole.numel());
    };
    picture.image = values(result.state.image);
    picture.alpha = values(result.foreground);
    if (result.state.normals.defined()) picture.normals = values(result.state.normals);
    if (result.state.labels.defined()) {
      const Tensor labels = result.state.labels.argmax(1).to(torch::kByte).contiguous();
      picture.labels.assign(labels.data_ptr<uint8_t>(), labels.data_ptr<uint8_t>() + labels.numel());
    }
    return picture;
  }

  RollOut& roll() { return roll_; }

 private:
  RollOut roll_;
};

MotionRenderer::MotionRenderer(const std::string& checkpoint_path, const MotionConfig& config,
                               const MotionRendererOptions& options)
    : impl_(std::make_unique<Impl>(checkpoint_path, config, options)) {}
MotionRenderer::~MotionRenderer() = default;

MotionPicture MotionRenderer::Next(const MotionFrame& frame) { return impl_->Next(frame); }
void MotionRenderer::Restart() { impl_->roll().Restart(); }
int64_t MotionRenderer::descriptors_kept() const { return impl_->roll().descriptors_kept(); }
int64_t MotionRenderer::projections_kept() const { return impl_->roll().projections_kept(); }

MotionScores ScoreMotion(const std::string& checkpoint_path, const MotionConfig& config,
                         const MotionFrameSource& source, const std::vector<FrameRange>& ranges,
                         const MotionRendererOptions& options) {
  RollOut roll(Loaded(checkpoint_path, config, options), options.warmup_iterations, options.reach);
  MotionScorer scorer(config);
  for (const FrameRange& range : ranges) {
    roll.Restart();
    scorer.Restart();
    for (int t = range.begin; t < range.end; ++t) {
      MotionFrame frame;
      source(t, true, &frame);
      const MotionStepResult result = roll.Next(frame);
      scorer.Add(result.state, TruthOf(std::span(&frame, 1), config), frame.before_x, frame.before_y);
    }
  }
  return scorer.Scores();
}

}  // namespace bodyloom
