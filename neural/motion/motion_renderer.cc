// SPDX-License-Identifier: Apache-2.0
#include "neural/motion/motion_renderer.h"

#include <span>

#include "neural/base/device.h"
#include "neural/motion/frame_tensors.h"
#include "neural/motion/motion_scorer.h"
#include "neural/motion/roll_out.h"
#include "neural/training/checkpoint.h"

namespace bodyloom {

class MotionRenderer::Impl {
 public:
  Impl(const std::string& path, const MotionConfig& config, const MotionRendererOptions& options)
      : config_(config),
        score_(options.score),
        scorer_(config_, {options.lpips, options.ssim}),
        roll_(LoadModel<MotionModel>(path, config, options.num_threads, options.device), options.warmup_iterations,
              {options.reach, options.whole_window}) {}

  MotionImage Next(const MotionFrame& frame) {
    const MotionStepResult result = roll_.Next(frame);
    if (score_) scorer_.Add(result.state, TruthOf(std::span(&frame, 1), config_), frame.before_x, frame.before_y);
    MotionImage rendered;
    rendered.width = frame.width;
    rendered.height = frame.height;
    rendered.image = HostValues<float>(result.state.image);
    rendered.alpha = HostValues<float>(result.foreground);
    if (result.state.normals.defined()) rendered.normals = HostValues<float>(result.state.normals);
    if (result.state.labels.defined()) rendered.labels = HostValues<uint8_t>(result.state.labels.argmax(1));
    return rendered;
  }

  void ForgetPast() { roll_.Restart(); }
  void Restart() {
    roll_.Restart();
    scorer_.Restart();
  }
  [[nodiscard]] MotionScores scores() const { return scorer_.Scores(); }
  [[nodiscard]] MotionFrameScores last_scores() const { return scorer_.last(); }
  [[nodiscard]] const RollOut& roll() const { return roll_; }

 private:
  MotionConfig config_;
  bool score_;
  MotionScorer scorer_;
  RollOut roll_;
};

MotionRenderer::MotionRenderer(const std::string& checkpoint_path, const MotionConfig& config,
                               const MotionRendererOptions& options)
    : impl_(std::make_unique<Impl>(checkpoint_path, config, options)) {}
MotionRenderer::~MotionRenderer() = default;

MotionImage MotionRenderer::Next(const MotionFrame& frame) { return impl_->Next(frame); }
void MotionRenderer::Restart() { impl_->Restart(); }
void MotionRenderer::ForgetPast() { impl_->ForgetPast(); }
MotionScores MotionRenderer::scores() const { return impl_->scores(); }
MotionFrameScores MotionRenderer::last_scores() const { return impl_->last_scores(); }
int64_t MotionRenderer::descriptors_kept() const { return impl_->roll().descriptors_kept(); }
int64_t MotionRenderer::projections_kept() const { return impl_->roll().projections_kept(); }

}  // namespace bodyloom
