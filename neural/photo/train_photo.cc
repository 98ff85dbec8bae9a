// SPDX-License-Identifier: Apache-2.0
#include "neural/photo/train_photo.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "geometry/base/check.h"
#include "geometry/base/prefetcher.h"
#include "neural/base/device.h"
#include "neural/losses/image_losses.h"
#include "neural/photo/photo_batch.h"
#include "neural/photo/photo_model.h"
#include "neural/training/optimizers.h"
#include "neural/training/renderer_trainer.h"
#include "render/texture/complete/body_part_map.h"
#include "render/texture/complete/partial_texture.h"

namespace bodyloom {
namespace {

using torch::Tensor;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

const PhotoSource& ValidationSource(const PhotoSource& source, const TrainPhotoOptions& options) {
  return options.validation_source != nullptr ? *options.validation_source : source;
}

class PhotoTrainer : public RendererTrainer {
 public:
  PhotoTrainer(const PhotoSource& source, const TrainPhotoOptions& options)
      : RendererTrainer(options, options.TotalSteps(), ToText(options.config),
                        {"loss", "perceptual", "face", "texture", "generator", "alpha", "discriminator"}, {}),
        source_(source),
        validation_source_(ValidationSource(source, options)),
        options_(options),
        config_(options.config),
        scoring_{std::make_shared<const Lpips>(LpipsFrom(options.alexnet, options.lpips_heads)), nullptr,
                 options.ssim} {
    torch::manual_seed(options.seed);  // independent of random numbers drawn for LPIPS' substitute
    if (config_.GuessesUnseen()) guess_.emplace(source.texture_size, source.texel_parts, source.texel_places);
    model_ = PhotoModel(config_);
    discriminator_ = PhotoDiscriminator(config_);
    model_->to(NeuralDevice());
    discriminator_->to(NeuralDevice());
    vgg_ = MakeFeatureNetwork(FeatureTrunk::kVgg19, {"relu1_1", "relu2_1", "relu3_1", "relu4_1", "relu5_1"},
                              options.vgg19, config_.profile.perceptual_divisor);
    if (options.sphereface.empty()) {
      losses_off_.emplace_back("face: no weights of SphereFace given");
    } else {
      sphereface_ = SphereFace();
      sphereface_->Load(options.sphereface.weights, options.sphereface.source);
      sphereface_->to(NeuralDevice());
      back_of_head_ = HeadTexelsOf(source.texel_parts, source.texel_places).back;
    }
    if (config_.variant == PhotoVariant::kNoInt) losses_off_.emplace_back("texture: left out by no-int");
    checkpoint_.Add("model", model_.ptr().get());
    AddJudge(discriminator_.ptr());
    const double rate = options.learning_rate;
    if (config_.Completes()) feature_optimizer_ = AddOptimizer("feature_optimizer", *model_->feature_net, rate);
    render_optimizer_ = AddOptimizer("render_optimizer", *model_->render_net, rate);
    discriminator_optimizer_ = AddOptimizer("discriminator_optimizer", *discriminator_, rate);
  }

  TrainPhotoSummary Run() {
    TrainPhotoSummary summary;
    static_cast<RendererTraining&>(summary) = Train();
    summary.scores = scores_;
    return summary;
  }

  void Begin(int first_step) override {
    batches_ =
        std::make_unique<Prefetcher<PhotoBatch>>(std::max(0, options_.TotalSteps() - first_step),
                                                 [this, first_step](int64_t i) { return BatchOf(first_step + i); });
  }

  [[nodiscard]] bool HasValidation() const override { return !options_.validation.empty(); }

  void Validate(int done, bool) override {
    const std::vector<PhotoPair> pairs =
        ValidationPairs(validation_source_, options_.validation, options_.validation_pairs);
    const size_t every = std::max<size_t>(1, pairs.size() / static_cast<size_t>(options_.preview_pairs));
    PersonScorer scorer(scoring_);
    std::vector<PhotoPreview> previews;
    for (size_t i = 0; i < pairs.size(); ++i) {
      const torch::NoGradGuard no_grad;
      PhotoPreview preview;
      preview.pair = pairs[i];
      validation_source_.fill(pairs[i].person, pairs[i].source, &preview.source);
      validation_source_.fill(pairs[i].person, pairs[i].target, &preview.target);
      PartialTexture texture = PartialTextureOf(preview.source);
      const bool shown = options_.preview && i % every == 0;
      if (shown) preview.partial_texture = texture.colour;
      if (guess_) GuessTexture(*guess_, &texture);
      const Tensor features = model_->Complete(ToTensors(std::span(&texture, 1)));
      preview.rendered = RenderPhoto(model_, features, preview.target, options_.reach);
      scorer.Add(preview.rendered, preview.target);
      if (!shown) continue;
      preview.completed_texture = HostValues<float>((0.5 * (features.slice(1, 0, 3) + 1)).clamp(0, 1));
      previews.push_back(std::move(preview));
    }
    scores_ = scorer.Scores();
    if (options_.preview) options_.preview(done, previews);
  }

  [[nodiscard]] std::vector<TrainingFigure> ScoreRow() const override {
    return {{"validation_l1", scores_.image_l1},
            {"validation_psnr_db", scores_.psnr_db},
            {"validation_ssim", scores_.ssim},
            {"validation_lpips", scores_.lpips},
            {"validation_outline_iou", scores_.silhouette_iou}};
  }

 private:
  [[nodiscard]] PhotoBatch BatchOf(int64_t step) const {
    std::vector<PhotoPair> pairs;
    pairs.reserve(static_cast<size_t>(options_.batch));
    for (int place = 0; place < options_.batch; ++place) {
      pairs.push_back(DrawPhotoPair(source_, options_.train, options_.seed, step, place));
    }
    return MakePhotoBatch(source_, pairs, options_.reach, config_.SmallestSide(), guess_ ? &*guess_ : nullptr,
                          back_of_head_);
  }

  /// Steps before RenderNet's training.
  [[nodiscard]] int InpaintSteps() const { return options_.TotalSteps() - options_.steps; }
  [[nodiscard]] bool IsJudged(int step) const { return step >= options_.FirstJudgedStep(); }
  [[nodiscard]] double RateShare(int step) const override {
    const int before = InpaintSteps();
    return step < before ? LinearDecayOverLastHalf(1, step, before)
                         : LinearDecayOverLastHalf(1, step - before, options_.steps);
  }
  [[nodiscard]] double ValidationPsnr() const override { return scores_.frames > 0 ? scores_.psnr_db : kNone; }

  bool Learn(int step) override {
    const PhotoBatch batch = batches_->Take();
    const bool judged = IsJudged(step);
    if (!(step < InpaintSteps() ? InpaintStep(batch) : RenderStep(batch, judged))) return false;
    if (!judged) Note("generator", kNone), Note("discriminator", kNone);
    return true;
  }

  bool InpaintStep(const PhotoBatch& batch) {
    Tensor total;
    Add("texture", 1, TextureLoss(model_->Complete(batch.source), batch.source, batch.target), &total);
    return Descend(total, {feature_optimizer_});
  }

  /// Computes F_s; fixed in kInpaint's second stage.
  Tensor Features(const PhotoBatch& batch) {
    if (config_.variant != PhotoVariant::kInpaint) return model_->Complete(batch.source);
    const torch::NoGradGuard no_grad;
    return model_->Complete(batch.source);
  }

  bool RenderStep(const PhotoBatch& batch, bool judged) {
    const Tensor features = Features(batch);
    const Tensor projected = model_->Project(features, batch.pose);
    const PhotoResult result = model_->Render(projected, batch.pose.body);
    const Tensor condition = projected.detach();
    const auto judge = [&](const Tensor& image) { return discriminator_(torch::cat({condition, image}, 1)); };
    if (judged && !LearnToJudge(DiscriminatorLoss(judge(batch.truth.image), judge(result.image.detach())),
                                discriminator_optimizer_)) {
      return false;
    }
    Tensor total;
    Add("alpha", options_.alpha_weight,
        torch::binary_cross_entropy_with_logits(result.alpha_logit, batch.truth.foreground), &total);
    if (options_.perceptual_weight > 0) {
      const SeenPair seen = See(result.image, batch.truth.image);
      Add("perceptual", options_.perceptual_weight, PerceptualLoss(seen.image, seen.truth), &total);
    }
    if (!sphereface_.is_empty() && options_.face_weight > 0) {
      Add("face", options_.face_weight, FaceLoss(sphereface_, result.image, batch.truth.image, batch.faces), &total);
    }
    if (config_.variant == PhotoVariant::kFull && options_.texture_weight > 0) {
      Add("texture", options_.texture_weight, TextureLoss(features, batch.source, batch.target), &total);
    }
    if (judged) {
      OnlyJudge();
      Add("generator", options_.gan_weight, GeneratorLoss(judge(result.image)), &total);
    }
    if (!config_.Completes() || config_.variant == PhotoVariant::kInpaint) return Descend(total, {render_optimizer_});
    return Descend(total, {render_optimizer_, feature_optimizer_});
  }

  const PhotoSource& source_;
  const PhotoSource& validation_source_;
  std::optional<TexelNeighbours> guess_;  ///< if the profile uses one
  std::vector<uint8_t> back_of_head_;     ///< if there is a face loss
  const TrainPhotoOptions& options_;
  const PhotoConfig& config_;
  PersonScoring scoring_;
  PhotoModel model_{nullptr};
  MultiScaleDiscriminator discriminator_{nullptr};
  SphereFace sphereface_{nullptr};  ///< empty without weights
  Adam *feature_optimizer_ = nullptr, *render_optimizer_ = nullptr, *discriminator_optimizer_ = nullptr;
  PersonScores scores_;
  std::unique_ptr<Prefetcher<PhotoBatch>> batches_;  ///< last member: its thread uses the others
};

}  // namespace

int TrainPhotoOptions::TotalSteps() const {
  if (config.variant != PhotoVariant::kInpaint) return steps;
  return steps + (inpaint_steps > 0 ? inpaint_steps : steps);
}

int TrainPhotoOptions::FirstJudgedStep() const {
  if (!(gan_weight > 0)) return TotalSteps();
  return TotalSteps() - steps + static_cast<int>(std::ceil(gan_from * steps));
}

bool TrainPhotoOptions::IsValid(std::string* why) const {
  const InRange in_range(why);
  if (train.empty()) {
    if (why != nullptr) *why = "nobody to train on";
    return false;
  }
  return IsValidRun(*this, why) && config.IsValid(why) && in_range("validation_pairs", validation_pairs, 1, 1e6) &&
         in_range("inpaint_steps", inpaint_steps, 0, 1e8) && in_range("batch", batch, 1, 256) &&
         in_range("learning_rate", learning_rate, 0, 1) && in_range("perceptual_weight", perceptual_weight, 0, 1e6) &&
         in_range("face_weight", face_weight, 0, 1e6) && in_range("texture_weight", texture_weight, 0, 1e6) &&
         in_range("gan_weight", gan_weight, 0, 1e6) && in_range("gan_from", gan_from, 0, 1) &&
         in_range("alpha_weight", alpha_weight, 0, 1e6) && in_range("reach", reach, 0, 4096) &&
         in_range("preview_pairs", preview_pairs, 1, 64);
}

TrainPhotoSummary TrainPhoto(const PhotoSource& source, const TrainPhotoOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "photo training: ", why);
  const PhotoProfile& p = options.config.profile;
  const auto check = [&](const PhotoSource& people, const std::vector<int>& persons) {
    BODYLOOM_CHECK(people.size == p.image_size && people.texture_size == p.texture_size, "photo training: images of ",
                   people.size, " pixels and textures of ", people.texture_size, " texels a side, expected ",
                   p.image_size, " and ", p.texture_size);
    for (const int person : persons) {
      BODYLOOM_CHECK(person >= 0 && static_cast<size_t>(person) < people.num_frames.size(), "photo training: person ",
                     person, " of ", people.num_frames.size());
    }
  };
  check(source, options.train);
  check(ValidationSource(source, options), options.validation);
  return PhotoTrainer(source, options).Run();
}

}  // namespace bodyloom
