// SPDX-License-Identifier: Apache-2.0
#include "neural/guided/train_guided.h"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "geometry/base/check.h"
#include "geometry/base/prefetcher.h"
#include "neural/base/device.h"
#include "neural/guided/choose_photos.h"
#include "neural/guided/guided_batches.h"
#include "neural/guided/guided_tensors.h"
#include "neural/guided/source_maps.h"
#include "neural/losses/image_losses.h"
#include "neural/training/renderer_trainer.h"

namespace bodyloom {
namespace {

using torch::Tensor;

enum Balanced { kPerceptual, kContextual, kGan, kKl, kNumBalanced };

constexpr const char* kBalancedNames[kNumBalanced] = {"perceptual", "contextual", "generator", "kl"};

class GuidedTrainer : public RendererTrainer {
 public:
  GuidedTrainer(const PhotoSource& people, const TrainGuidedOptions& options)
      : RendererTrainer(options, options.steps, ToText(options.config),
                        {"silhouette", "labels", "image", "outline", "perceptual", "contextual", "generator", "kl",
                         "discriminator", "render"},
                        {"image"}),
        people_(people),
        options_(options),
        config_(options.config),
        balance_(kNumBalanced, options.balance_steps) {
    if (config_.NeedsNeighbours()) {
      neighbours_.emplace(people.texture_size, people.texel_parts, people.texel_places);
    }
    model_ = GuidedModel(config_);
    discriminator_ = GuidedDiscriminator(config_);
    model_->to(NeuralDevice());
    discriminator_->to(NeuralDevice());
    vgg_ = MakeFeatureNetwork(FeatureTrunk::kVgg16, {"conv1_2", "conv2_2", "conv3_2", "conv4_2"}, options.vgg16,
                              config_.profile.perceptual_divisor);
    checkpoint_.Add("model", model_.ptr().get());
    AddJudge(discriminator_.ptr());
    // One optimizer is equivalent to three: Adam treats weights independently, and no loss depends on two networks.
    optimizer_ = AddOptimizer("optimizer", *model_, options.learning_rate);
    discriminator_optimizer_ = AddOptimizer("discriminator_optimizer", *discriminator_, options.discriminator_rate);
    checkpoint_.Add("loss_weights", balance_.state());
  }

  TrainGuidedSummary Run() {
    TrainGuidedSummary summary;
    model_->train();
    static_cast<RendererTraining&>(summary) = Train();
    summary.scores = scores_;
    if (balance_.IsSet()) {
      for (int i = 0; i < kNumBalanced; ++i) summary.loss_weights.push_back(balance_.Weight(i));
    }
    return summary;
  }

  void Begin(int first_step) override {
    batches_ = std::make_unique<Prefetcher<GuidedBatch>>(
        std::max(0, options_.steps - first_step), [this, first_step](int64_t i) {
          return MakeGuidedBatch(people_, config_, options_.seed, first_step + i, options_.batch, options_.reach,
                                 neighbours_ ? &*neighbours_ : nullptr);
        });
  }

  [[nodiscard]] bool HasValidation() const override { return !options_.validation.num_frames.empty(); }

  void Validate(int done, bool last) override {
    model_->eval();
    const PhotoSource& people = options_.validation;
    PersonScorer scorer(last ? LikenessScoring(options_.score_weights) : PersonScoring());
    std::vector<GuidedPreview> previews;
    const int count = std::min(static_cast<int>(people.num_frames.size()), options_.validation_people);
    for (int person = 0; person < count; ++person) {
      if (static_cast<int>(photos_.size()) <= person) photos_.push_back(ChoosePhotos(people, person, 1).front());
      PhotoFrame photo;
      people.fill(person, photos_[person], &photo);
      const torch::NoGradGuard no_grad;
      const GuidedSource source = model_->EncodeSource(TensorsOf(std::span(&photo, 1)));
      const auto draw = [&](const PhotoFrame& frame, const PseudoImage& pseudo) {
        return DrawGuided(&model_, source, frame, pseudo, options_.reach, nullptr);
      };
      MapCompletion completion = config_.Completion();
      std::vector<PhotoFrame> views;
      // The six views of the body are not needed for completion by nearest texels.
      if (options_.validation_views && completion != MapCompletion::kNearest) views = options_.validation_views(person);
      if (completion == MapCompletion::kVirtualViews && views.empty()) completion = MapCompletion::kNone;
      const SourceBody body = {
          people.texel_parts, views, neighbours_ ? &*neighbours_ : nullptr, {}, config_.source_labels};
      const CoherentMaps maps =
          MapsOfSource(std::span(&photo, 1), body, completion, config_.profile.contour_hints, draw).maps;
      const int frames = std::min(people.num_frames[person] - 1, options_.validation_frames);
      for (int k = 0; k < frames; ++k) {
        // Spread over the person's images except the photo.
        const int frame =
            (photos_[person] + 1 + k * (people.num_frames[person] - 1) / frames) % people.num_frames[person];
        GuidedPreview preview;
        preview.person = person;
        preview.frame = frame;
        people.fill(person, frame, &preview.truth);
        preview.pseudo = LookUp(maps, preview.truth);
        preview.rendered = draw(preview.truth, preview.pseudo);
        scorer.Add(preview.rendered, preview.truth);
        if (!options_.preview || k != 0) continue;
        preview.source = photo;
        previews.push_back(std::move(preview));
      }
      scorer.NextPerson();
    }
    scores_ = scorer.Scores();
    model_->train();
    if (options_.preview) options_.preview(done, previews);
  }

  [[nodiscard]] std::vector<TrainingFigure> ScoreRow() const override {
    return {{"validation_l1", scores_.image_l1},
            {"validation_psnr_db", scores_.psnr_db},
            {"validation_silhouette_iou", scores_.silhouette_iou},
            {"validation_label_iou", scores_.label_iou},
            {"validation_lpips", scores_.lpips},
            {"validation_contextual", scores_.contextual}};
  }

 private:
  [[nodiscard]] double ValidationPsnr() const override {
    return scores_.frames > 0 ? scores_.psnr_db : std::numeric_limits<double>::quiet_NaN();
  }

  [[nodiscard]] double Share(int loss) const {
    return std::array{options_.perceptual_share, options_.contextual_share, options_.gan_share,
                      config_.kl && config_.latent ? options_.kl_share : 0.0}[loss];
  }

  /// Silhouette and labels for RenderNet: true ones, or those predicted by the other two networks from true inputs.
  std::pair<Tensor, Tensor> RenderInputs(const GuidedBatch& batch, const GuidedSource& source,
                                         const Tensor& silhouette_logits, int step) {
    Tensor silhouette = batch.target.silhouette, classes = batch.target.classes;
    if (step < options_.predicted_from * options_.steps) return {silhouette, classes};
    const torch::NoGradGuard no_grad;
    Tensor predicted;
    if (config_.silhouettes) silhouette = predicted = torch::sigmoid(silhouette_logits);
    if (config_.garments) {
      const Tensor logits = model_->Labels(source, batch.target.pose, predicted, batch.pseudo.classes, batch.Whole());
      classes = logits.argmax(1, true).to(torch::kFloat);
      if (!config_.silhouettes) silhouette = 1 - torch::softmax(logits, 1).slice(1, 0, 1);
    }
    return {silhouette.detach(), classes};
  }

  bool Learn(int step) override {
    const GuidedBatch batch = batches_->Take();
    const GuidedTensors& truth = batch.target;
    const GuidedSource source = CroppedEach(model_->EncodeSource(batch.source), batch.boxes);
    const CodeBox whole = batch.Whole();
    Tensor total;
    Tensor silhouette_logits;
    if (config_.silhouettes) {
      silhouette_logits = model_->Silhouette(source, truth.pose, batch.pseudo, whole);
      Add("silhouette", 1, L1Loss(torch::sigmoid(silhouette_logits), truth.silhouette), &total);
    }
    if (config_.garments) {
      const Tensor logits = model_->Labels(source, truth.pose, config_.silhouettes ? truth.silhouette : Tensor(),
                                           batch.pseudo.classes, whole);
      const Tensor one_hot = OneHot(truth.classes.squeeze(1).to(torch::kLong), kPhotoLabels);
      Add("labels", 1,
          options_.labels_by_cross_entropy ? SoftLabelCrossEntropy(logits, one_hot) : SoftLabelL1Loss(logits, one_hot),
          &total);
    }
    const auto [silhouette, classes] = RenderInputs(batch, source, silhouette_logits, step);
    const RenderCode& code = source.render_code;
    const Tensor noise = code.log_variance.defined() ? RandnLike(code.mean) : Tensor();
    const auto [image, mask] = model_->Render(Draw(code, noise), truth.pose, silhouette, classes, batch.pseudo, whole);
    Tensor render;
    Add("image", 1, L1Loss(image, truth.image), &render);
    if (!config_.silhouettes && !config_.garments) Add("outline", 1, L1Loss(mask, truth.silhouette), &render);
    if (options_.gan_share > 0 && !LearnToJudge(DiscriminatorLoss({discriminator_(Judged(truth, truth.image))},
                                                                  {discriminator_(Judged(truth, image.detach()))}),
                                                discriminator_optimizer_)) {
      return false;
    }
    render = render + BalancedLosses(batch, image, code, step);
    Add("render", 1, render, &total);
    if (!Descend(total, {optimizer_})) return false;
    std::array<double, kNumBalanced> balanced{};
    for (int i = 0; i < kNumBalanced; ++i) balanced[i] = Noted(kBalancedNames[i]);
    balance_.Measure(Noted("image"), balanced);
    return true;
  }

  [[nodiscard]] Tensor Judged(const GuidedTensors& truth, const Tensor& image) const {
    return torch::cat({model_->LabelMap(truth.classes), image}, 1);
  }

  /// λ-weighted sum; until the weights are set the losses are only measured.
  Tensor BalancedLosses(const GuidedBatch& batch, const Tensor& image, const RenderCode& code, int step) {
    const torch::AutoGradMode mode(balance_.IsSet());
    Tensor sum = torch::zeros({}, image.options().requires_grad(false));
    const auto add = [&](Balanced which, const Tensor& loss) {
      Note(kBalancedNames[which], loss.item<double>());
      if (balance_.IsSet()) sum = sum + Share(which) * balance_.Weight(which) * loss;
    };
    if (Share(kPerceptual) > 0 || Share(kContextual) > 0) {
      const SeenPair seen = See(image, batch.target.image);
      if (Share(kPerceptual) > 0) add(kPerceptual, PerceptualLoss(seen.image, seen.truth));
      if (Share(kContextual) > 0) {
        ContextualOptions contextual;
        contextual.max_points = config_.profile.contextual_points;
        contextual.seed = static_cast<uint64_t>(step);
        add(kContextual, ContextualLoss(seen.image[2], seen.truth[2], contextual));
      }
    }
    if (Share(kGan) > 0) {
      OnlyJudge();
      add(kGan, GeneratorLoss({discriminator_(Judged(batch.target, image))}));
    }
    if (code.log_variance.defined() && Share(kKl) > 0) {
      const double numbers = static_cast<double>(code.mean.numel()) / static_cast<double>(code.mean.size(0));
      add(kKl, KlLoss(code.mean, code.log_variance) / numbers);
    }
    return sum;
  }

  const PhotoSource& people_;
  const TrainGuidedOptions& options_;
  const GuidedConfig& config_;
  LossBalance balance_;
  std::optional<TexelNeighbours> neighbours_;  ///< set if the maps are completed by them
  GuidedModel model_{nullptr};
  PatchDiscriminator discriminator_{nullptr};
  Adam *optimizer_ = nullptr, *discriminator_optimizer_ = nullptr;
  PersonScores scores_;
  std::vector<int> photos_;                           ///< of the people validated on
  std::unique_ptr<Prefetcher<GuidedBatch>> batches_;  ///< last member: its thread uses the others
};

}  // namespace

bool TrainGuidedOptions::IsValid(std::string* why) const {
  const InRange in_range(why);
  return IsValidRun(*this, why) && config.IsValid(why) && in_range("batch", batch, 1, 256) &&
         in_range("learning_rate", learning_rate, 0, 1) && in_range("discriminator_rate", discriminator_rate, 0, 1) &&
         in_range("balance_steps", balance_steps, 1, 1e8) && in_range("perceptual_share", perceptual_share, 0, 1e6) &&
         in_range("contextual_share", contextual_share, 0, 1e6) && in_range("gan_share", gan_share, 0, 1e6) &&
         in_range("kl_share", kl_share, 0, 1e6) && in_range("predicted_from", predicted_from, 0, 1) &&
         in_range("reach", reach, 0, 8192) && in_range("validation_people", validation_people, 1, 1e6) &&
         in_range("validation_frames", validation_frames, 1, 1e6);
}

TrainGuidedSummary TrainGuided(const PhotoSource& people, const TrainGuidedOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "pose-guided training: ", why);
  BODYLOOM_CHECK(!people.num_frames.empty() && people.fill, "pose-guided training: nobody to train on");
  BODYLOOM_CHECK(people.size == options.config.profile.image_size, "pose-guided training: images of ", people.size,
                 " px, expected ", options.config.profile.image_size);
  return GuidedTrainer(people, options).Run();
}

}  // namespace bodyloom
