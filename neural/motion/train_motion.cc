// SPDX-License-Identifier: Apache-2.0
#include "neural/motion/train_motion.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <span>

#include "geometry/base/check.h"
#include "neural/base/device.h"
#include "neural/losses/image_losses.h"
#include "neural/motion/motion_scorer.h"
#include "neural/motion/roll_out.h"
#include "neural/networks/patch_discriminator.h"
#include "neural/training/optimizers.h"
#include "neural/training/renderer_trainer.h"

namespace bodyloom {
namespace {

using torch::Tensor;

/// Frames of each range scored for metrics.csv, so that its lines are comparable; the summary uses all frames.
constexpr int kQuickFrames = 48;

class MotionTrainer : public RendererTrainer {
 public:
  MotionTrainer(const MotionFrameSource& source, const TrainMotionOptions& options)
      : RendererTrainer(options, options.steps, ToText(options.config),
                        {"loss", "image", "shape", "normals", "perceptual", "generator", "discriminator"}, {"image"}),
        source_(source),
        options_(options),
        config_(options.config) {
    model_ = MotionModel(config_);
    MotionFrame first;
    source(options.train.front().begin, true, &first);
    has_labels_ = !first.labels.empty();
    has_normals_ = !first.normals.empty();
    if (config_.shape && !has_labels_) losses_off_.emplace_back("shape: the frames have no labels");
    if (config_.normals && !has_normals_) losses_off_.emplace_back("normals: the frames have no normals");
    discriminator_ = PatchDiscriminator(
        PatchDiscriminatorOptions{3 + (has_labels_ ? config_.num_labels : 0), config_.profile.discriminator_width});
    model_->to(NeuralDevice());
    discriminator_->to(NeuralDevice());
    vgg_ = MakeFeatureNetwork(FeatureTrunk::kVgg16, {"conv1_2", "conv2_2", "conv3_2", "conv4_2"}, options.vgg16,
                              config_.profile.perceptual_divisor);
    if (options.average > 0) {
      average_ = MotionModel(config_);
      average_->to(NeuralDevice());
      checkpoint_.Add("learner", model_.ptr().get());
    }
    checkpoint_.Add("model", Shown().ptr().get());
    AddJudge(discriminator_.ptr());
    optimizer_ = AddOptimizer("optimizer", *model_, options.learning_rate);
    discriminator_optimizer_ = AddOptimizer("discriminator_optimizer", *discriminator_, options.discriminator_rate);
    memory_ = std::make_unique<RolloutMemory>(model_->InitialState(1, first.height, first.width), options.batch,
                                              options.rollouts);
    memory_->AddTo(&checkpoint_);
    checkpoint_.Add("best", &best_);
  }

  TrainMotionSummary Run() {
    TrainMotionSummary summary;
    static_cast<RendererTraining&>(summary) = Train();
    summary.scores = all_scores_.frames > 0 ? all_scores_ : scores_;
    return summary;
  }

  void Begin(int first_step) override {
    batches_ = std::make_unique<MotionBatches>(
        source_, config_, options_.reach,
        RolloutPlan(options_.train,
                    {options_.batch, options_.rollouts, options_.rollout_length, /*from_truth=*/0.75, options_.seed}),
        first_step, options_.steps);
    memory_->Begin();
  }

  [[nodiscard]] bool HasValidation() const override { return !options_.validation.empty(); }

  void Validate(int done, bool last) override {
    std::vector<MotionPreview> previews;
    // LPIPS and tLPIPS are slow: only at the end.
    const auto lpips =
        last ? std::make_shared<const Lpips>(LpipsFrom(options_.alexnet, options_.lpips_heads)) : nullptr;
    MotionScorer quick(config_, {nullptr, options_.ssim}), all(config_, {lpips, options_.ssim});
    RollOut roll(Shown(), options_.warmup_iterations, {options_.reach, /*whole_window=*/true});
    for (const FrameRange& range : options_.validation) {
      roll.Restart();
      quick.Restart();
      all.Restart();
      const int quick_end = std::min(range.end, range.begin + kQuickFrames), end = last ? range.end : quick_end;
      const int every = std::max(1, (end - range.begin) / std::max(1, options_.preview_frames));
      for (int t = range.begin; t < end; ++t) {
        MotionFrame frame;
        (options_.validation_source ? options_.validation_source : source_)(t, true, &frame);
        const MotionStepResult result = roll.Next(frame);
        const MotionTruth truth = TruthOf(std::span(&frame, 1), config_);
        if (t < quick_end) quick.Add(result.state, truth, frame.before_x, frame.before_y);
        if (last) all.Add(result.state, truth, frame.before_x, frame.before_y);
        if (!options_.preview || (t - range.begin) % every != every / 2) continue;
        MotionPreview preview;
        preview.frame = t, preview.width = frame.width, preview.height = frame.height;
        preview.image = HostValues<float>(result.state.image);
        if (result.state.normals.defined()) preview.normals = HostValues<float>(result.state.normals);
        if (result.state.labels.defined()) preview.labels = HostValues<uint8_t>(result.state.labels.argmax(1));
        preview.true_image = frame.image, preview.true_normals = frame.normals, preview.true_labels = frame.labels;
        previews.push_back(std::move(preview));
      }
    }
    scores_ = quick.Scores();
    if (last) all_scores_ = all.Scores();
    const bool better = scores_.image_l1 < best_[0].item<double>();
    best_ = better ? torch::tensor({scores_.image_l1, 0.0}, torch::kDouble)
                   : torch::tensor({best_[0].item<double>(), ValidationsSinceBest() + 1.0}, torch::kDouble);
    if (options_.preview) options_.preview(done, previews);
  }

  [[nodiscard]] int ValidationsSinceBest() const override { return static_cast<int>(best_[1].item<double>()); }

  [[nodiscard]] std::vector<TrainingFigure> ScoreRow() const override {
    return {{"validation_l1", scores_.image_l1},
            {"validation_psnr_db", scores_.psnr_db},
            {"validation_label_iou", scores_.label_iou},
            {"validation_foreground_iou", scores_.foreground_iou},
            {"validation_normal_deg", scores_.normal_deg},
            {"validation_flicker", scores_.flicker},
            {"validation_ssim", scores_.ssim}};
  }

 private:
  /// The model that is validated and kept for inference.
  [[nodiscard]] MotionModel& Shown() { return average_ ? average_ : model_; }

  [[nodiscard]] double ValidationPsnr() const override {
    return scores_.frames > 0 ? scores_.psnr_db : std::numeric_limits<double>::quiet_NaN();
  }

  bool Learn(int step) override {
    const MotionBatch batch = batches_->Take();
    const MotionTruth& truth = batch.truth;
    const MotionStepResult result = model_(batch.input, memory_->Before(batch));
    const MotionState& state = result.state;
    // Colour losses use the true foreground, as the outline is learned by the classes. With the predicted foreground,
    // colours would turn dark where the person is rarely present.
    const Tensor image = has_labels_ && config_.shape ? truth.foreground * result.colour : state.image;
    const auto condition = [&](const Tensor& colours) {
      return has_labels_ ? torch::cat({truth.labels, colours}, 1) : colours;
    };
    if (options_.gan_weight > 0 && !LearnToJudge(DiscriminatorLoss({discriminator_(condition(truth.image))},
                                                                   {discriminator_(condition(image.detach()))}),
                                                 discriminator_optimizer_)) {
      return false;
    }
    Tensor total;
    Add("image", 1, L1Loss(image, truth.image), &total);
    if (config_.shape && has_labels_) {
      Add("shape", options_.shape_weight,
          options_.shape_by_cross_entropy ? SoftLabelCrossEntropy(result.label_logits, truth.labels)
                                          : L1Loss(state.labels, truth.labels),
          &total);
    }
    if (config_.normals && has_normals_) {
      Add("normals", options_.normal_weight, L1Loss(state.normals, truth.normals), &total);
    }
    if (options_.perceptual_weight > 0) {
      const SeenPair seen = See(image, truth.image);
      Add("perceptual", options_.perceptual_weight, PerceptualLoss(seen.image, seen.truth), &total);
    }
    if (options_.gan_weight > 0) {
      OnlyJudge();
      Add("generator", options_.gan_weight, GeneratorLoss({discriminator_(condition(image))}), &total);
    }
    if (!Descend(total, {optimizer_})) return false;
    memory_->Keep(batch, state);
    if (average_) AverageWeights(*model_, step + 1, options_.average, average_.get());
    return true;
  }

  const MotionFrameSource& source_;
  const TrainMotionOptions& options_;
  const MotionConfig& config_;
  bool has_labels_ = false, has_normals_ = false;
  MotionModel model_{nullptr};
  MotionModel average_{nullptr};  ///< average of model_'s weights; empty: disabled
  PatchDiscriminator discriminator_{nullptr};
  Adam *optimizer_ = nullptr, *discriminator_optimizer_ = nullptr;
  std::unique_ptr<RolloutMemory> memory_;
  MotionScores scores_, all_scores_;  ///< of the last validation: first frames of each range, and all frames
  Tensor best_ = torch::tensor({1e9, 0.0}, torch::kDouble);  ///< minimum L1 of the validations, and validations since
  std::unique_ptr<MotionBatches> batches_;
};

}  // namespace

bool TrainMotionOptions::IsValid(std::string* why) const {
  const InRange in_range(why);
  if (train.empty()) {
    if (why != nullptr) *why = "no frames to train on";
    return false;
  }
  for (const auto& ranges : {train, validation}) {
    for (const FrameRange& range : ranges) {
      if (range.begin >= 0 && range.end > range.begin) continue;
      if (why != nullptr) *why = Concatenate("frames ", range.begin, " to ", range.end, ", expected at least one");
      return false;
    }
  }
  if (config.around_body && reach < 1) {
    if (why != nullptr) *why = Concatenate("reach ", reach, " px around the body, expected at least 1");
    return false;
  }
  return IsValidRun(*this, why) && config.IsValid(why) && in_range("reach", reach, 0, 1e6) &&
         in_range("batch", batch, 1, 256) && in_range("rollout_length", rollout_length, 1, 1e6) &&
         in_range("rollouts", rollouts, 1, 1024) && in_range("learning_rate", learning_rate, 0, 1) &&
         in_range("discriminator_rate", discriminator_rate, 0, 1) && in_range("shape_weight", shape_weight, 0, 1e6) &&
         in_range("normal_weight", normal_weight, 0, 1e6) && in_range("perceptual_weight", perceptual_weight, 0, 1e6) &&
         in_range("gan_weight", gan_weight, 0, 1e6) && in_range("warmup_iterations", warmup_iterations, 0, 1000) &&
         in_range("average", average, 0, 0.5) && in_range("preview_frames", preview_frames, 1, 64);
}

TrainMotionSummary TrainMotion(const MotionFrameSource& source, const TrainMotionOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "motion training: ", why);
  return MotionTrainer(source, options).Run();
}

}  // namespace bodyloom
