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
#include "neural/base/runtime.h"
#include "neural/losses/gan_losses.h"
#include "neural/losses/image_losses.h"
#include "neural/networks/vgg.h"
#include "neural/photo/photo_batch.h"
#include "neural/photo/photo_losses.h"
#include "neural/photo/photo_model.h"
#include "neural/photo/render_photo.h"
#include "neural/training/optimizers.h"
#include "neural/training/training_loop.h"
#include "render/texture/complete/body_part_map.h"
#include "render/texture/complete/partial_texture.h"

namespace bodyloom {
namespace {

using torch::Tensor;
using torch::optim::Adam;

const std::vector<std::string> kPhotoColumns = {"learning_rate",
                                                "loss",
                                                "perceptual",
                                                "face",
                                                "texture",
                                                "generator",
                                                "alpha",
                                                "discriminator",
                                                "validation_l1",
                                                "validation_psnr_db",
                                                "validation_ssim",
                                                "validation_lpips",
                                                "validation_outline_iou"};

struct PhotoLosses {
  double total = 0, perceptual = 0, face = 0, texture = 0, generator = 0, alpha = 0, discriminator = 0;
  [[nodiscard]] bool IsFinite() const { return std::isfinite(total + discriminator); }
};

const PhotoSource& ValidationSource(const PhotoSource& source, const TrainPhotoOptions& options) {
  return options.validation_source != nullptr ? *options.validation_source : source;
}

class PhotoTrainer : public TrainedSystem {
 public:
  PhotoTrainer(const PhotoSource& source, const TrainPhotoOptions& options)
      : source_(source),
        validation_source_(ValidationSource(source, options)),
        options_(options),
        config_(options.config),
        lpips_(LpipsFrom(options.alexnet, options.lpips_heads)) {
    torch::manual_seed(options.seed);
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
    checkpoint_ = std::make_unique<Checkpoint>(ToText(config_));
    checkpoint_->config_json = options.config_json;
    checkpoint_->Add("model", model_.ptr().get());
    checkpoint_->Add("discriminator", discriminator_.ptr().get());
    const auto optimizer = [&](const char* name, const torch::nn::Module& module) {
      std::unique_ptr<Adam> adam = MakeAdam(module, options.learning_rate);
      checkpoint_->Add(name, adam.get());
      return adam;
    };
    if (config_.Completes()) feature_optimizer_ = optimizer("feature_optimizer", *model_->feature_net);
    render_optimizer_ = optimizer("render_optimizer", *model_->render_net);
    discriminator_optimizer_ = optimizer("discriminator_optimizer", *discriminator_);
  }

  TrainPhotoSummary Run() {
    TrainPhotoSummary summary;
    static_cast<TrainingOutcome&>(summary) =
        RunTraining(options_, options_.TotalSteps(), kPhotoColumns, checkpoint_.get(), this);
    summary.losses_off = losses_off_;
    summary.perceptual_random_features = vgg_->has_random_features;
    summary.scores = scores_;
    return summary;
  }

  void Begin(int first_step) override {
    batches_ =
        std::make_unique<Prefetcher<PhotoBatch>>(std::max(0, options_.TotalSteps() - first_step),
                                                 [this, first_step](int64_t i) { return BatchOf(first_step + i); });
  }

  bool Step(int step) override {
    const double rate = Rate(step);
    for (Adam* optimizer : {feature_optimizer_.get(), render_optimizer_.get(), discriminator_optimizer_.get()}) {
      if (optimizer == nullptr) continue;
      SetRate(optimizer, rate);
      optimizer->zero_grad();
    }
    const PhotoBatch batch = batches_->Take();
    losses_ = step < InpaintSteps() ? InpaintStep(batch) : RenderStep(batch, IsJudged(step));
    return losses_.IsFinite();
  }

  [[nodiscard]] bool HasValidation() const override { return !options_.validation.empty(); }

  void Validate(int done, bool) override {
    const std::vector<PhotoPair> pairs =
        ValidationPairs(validation_source_, options_.validation, options_.validation_pairs);
    const size_t every = std::max<size_t>(1, pairs.size() / static_cast<size_t>(options_.preview_pairs));
    PhotoScorer scorer(lpips_, options_.ssim);
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
      preview.picture = RenderPhoto(model_, features, preview.target, options_.reach);
      scorer.Add(preview.picture, preview.target);
      if (!shown) continue;
      preview.completed_texture = HostValues<float>((0.5 * (features.slice(1, 0, 3) + 1)).clamp(0, 1));
      previews.push_back(std::move(preview));
    }
    scores_ = scorer.Scores();
    if (options_.preview) options_.preview(done, previews);
  }

  [[nodiscard]] std::vector<double> Row(int done) const override {
    const PhotoLosses& l = losses_;
    const auto judged = [&](double loss) {
      return IsJudged(done - 1) ? loss : std::numeric_limits<double>::quiet_NaN();
    };
    return {Rate(done - 1),      l.total, l.perceptual,           l.face, l.texture,
            judged(l.generator), l.alpha, judged(l.discriminator)};
  }

  [[nodiscard]] std::vector<double> ScoreRow() const override {
    return {scores_.image_l1, scores_.psnr_db, scores_.ssim, scores_.lpips, scores_.silhouette_iou};
  }

  bool Report(int done, double seconds) override {
    return !options_.progress || options_.progress({done, options_.TotalSteps(), losses_.total, scores_, seconds});
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

  /// Steps before RenderNet's turn.
  [[nodiscard]] int InpaintSteps() const { return options_.TotalSteps() - options_.steps; }
  [[nodiscard]] bool IsJudged(int step) const { return step >= options_.FirstJudgedStep(); }
  [[nodiscard]] double Rate(int step) const {
    const int before = InpaintSteps();
    return step < before ? LinearDecayOverLastHalf(options_.learning_rate, step, before)
                         : LinearDecayOverLastHalf(options_.learning_rate, step - before, options_.steps);
  }

  PhotoLosses InpaintStep(const PhotoBatch& batch) {
    PhotoLosses losses;
    const Tensor loss = TextureLoss(model_->Complete(batch.source), batch.source, batch.target);
    loss.backward();
    losses.total = losses.texture = loss.item<double>();
    if (losses.IsFinite()) feature_optimizer_->step();
    return losses;
  }

  /// F_s; fixed in kInpaint's second stage.
  Tensor Features(const PhotoBatch& batch) {
    if (config_.variant != PhotoVariant::kInpaint) return model_->Complete(batch.source);
    const torch::NoGradGuard no_grad;
    return model_->Complete(batch.source);
  }

  PhotoLosses RenderStep(const PhotoBatch& batch, bool judged) {
    PhotoLosses losses;
    const Tensor features = Features(batch);
    const Tensor projected = model_->Project(features, batch.pose);
    const PhotoResult result = model_->Render(projected, batch.pose.body);
    const Tensor condition = projected.detach();
    const auto judge = [&](const Tensor& image) { return discriminator_(torch::cat({condition, image}, 1)); };
    if (judged) {
      const Tensor loss = DiscriminatorLoss(judge(batch.truth.image), judge(result.image.detach()));
      loss.backward();
      losses.discriminator = loss.item<double>();
      if (!std::isfinite(losses.discriminator)) return losses;
      discriminator_optimizer_->step();
    }
    const Tensor alpha = torch::binary_cross_entropy_with_logits(result.alpha_logit, batch.truth.foreground);
    losses.alpha = alpha.item<double>();
    Tensor total = options_.alpha_weight * alpha;
    const auto add = [&](double weight, const Tensor& loss, double* value) {
      *value = loss.item<double>();
      total = total + weight * loss;
    };
    if (options_.perceptual_weight > 0) {
      std::vector<Tensor> target;
      {
        const torch::NoGradGuard no_grad;
        target = vgg_(batch.truth.image);
      }
      add(options_.perceptual_weight, PerceptualLoss(vgg_(result.image), target), &losses.perceptual);
    }
    if (!sphereface_.is_empty() && options_.face_weight > 0) {
      add(options_.face_weight, FaceLoss(sphereface_, result.image, batch.truth.image, batch.faces), &losses.face);
    }
    if (config_.variant == PhotoVariant::kFull && options_.texture_weight > 0) {
      add(options_.texture_weight, TextureLoss(features, batch.source, batch.target), &losses.texture);
    }
    if (judged) {
      RequireGradients(discriminator_.get(), false);
      add(options_.gan_weight, GeneratorLoss(judge(result.image)), &losses.generator);
    }
    total.backward();
    RequireGradients(discriminator_.get(), true);
    losses.total = total.item<double>();
    if (!losses.IsFinite()) return losses;  // a step would spoil the weights
    render_optimizer_->step();
    if (config_.Completes() && config_.variant != PhotoVariant::kInpaint) feature_optimizer_->step();
    return losses;
  }

  const PhotoSource& source_;
  const PhotoSource& validation_source_;
  std::optional<TexelNeighbours> guess_;  ///< where the profile has one
  std::vector<uint8_t> back_of_head_;     ///< where faces are judged
  const TrainPhotoOptions& options_;
  const PhotoConfig& config_;
  Lpips lpips_;
  std::vector<std::string> losses_off_;
  PhotoModel model_{nullptr};
  MultiScaleDiscriminator discriminator_{nullptr};
  FeatureNetwork vgg_{nullptr};
  SphereFace sphereface_{nullptr};  ///< empty without weights
  std::unique_ptr<Adam> feature_optimizer_, render_optimizer_, discriminator_optimizer_;
  std::unique_ptr<Checkpoint> checkpoint_;
  PhotoScores scores_;
  PhotoLosses losses_;                               ///< of the last step
  std::unique_ptr<Prefetcher<PhotoBatch>> batches_;  ///< last: its thread uses the rest
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
    BODYLOOM_CHECK(people.size == p.image_size && people.texture_size == p.texture_size, "photo training: pictures of ",
                   people.size, " pixels and textures of ", people.texture_size, " texels a side, expected ",
                   p.image_size, " and ", p.texture_size);
    for (const int person : persons) {
      BODYLOOM_CHECK(person >= 0 && static_cast<size_t>(person) < people.num_frames.size(), "photo training: person ",
                     person, " of ", people.num_frames.size());
    }
  };
  check(source, options.train);
  check(ValidationSource(source, options), options.validation);
  StartNeuralRuntime(options.num_threads);
  UseNeuralDevice(options.device);
  return PhotoTrainer(source, options).Run();
}

}  // namespace bodyloom
