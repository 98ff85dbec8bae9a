// SPDX-License-Identifier: Apache-2.0
#include "neural/parser/train_parser.h"

#include <torch/torch.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/prefetcher.h"
#include "neural/base/device.h"
#include "neural/base/runtime.h"
#include "neural/metrics/pixel_metrics.h"
#include "neural/networks/image_unet_module.h"
#include "neural/parser/image_crops.h"
#include "neural/training/checkpoint.h"
#include "neural/training/optimizers.h"
#include "neural/training/training_loop.h"

namespace bodyloom {
namespace {

/// Common training of U-Nets on images: crops (image_crops.h) prefetched by a thread, AdamW with a cosine schedule,
/// averaged weights (neural/training/optimizers.h).
class ImageTrainer : public TrainedSystem {
 public:
  void Begin(int first_step) override;
  bool Step(int step) override;

 protected:
  /// `module` is trained and `average` becomes its average: both of one type with the same weights, on the networks'
  /// device. `side`, `batch`, `seed` and `light_strength` of `request` are set from `training`. `training` and `train`
  /// must outlive this.
  ImageTrainer(const std::string& name, const ImageTraining& training, const std::vector<PackedImage>& train,
               CropRequest request, std::shared_ptr<torch::nn::Module> module,
               std::shared_ptr<torch::nn::Module> average);

  virtual torch::Tensor LossOf(const CropBatch& batch) = 0;

  TrainingOutcome Train();
  [[nodiscard]] double LearningRate(int step) const;
  /// Figures before those of a validation: learning rate, loss.
  [[nodiscard]] std::vector<TrainingFigure> Row(int done) const override;
  [[nodiscard]] double loss() const { return loss_; }

 private:
  const ImageTraining& training_;
  const std::vector<PackedImage>& train_;
  CropRequest request_;
  std::shared_ptr<torch::nn::Module> module_, average_;
  std::unique_ptr<torch::optim::AdamW> optimizer_;
  Checkpoint checkpoint_;
  double loss_ = 0;                                 ///< of the last reported step
  std::unique_ptr<Prefetcher<CropBatch>> batches_;  ///< last member: its thread uses the others
};

constexpr double kClipNorm = 1;

ImageTrainer::ImageTrainer(const std::string& name, const ImageTraining& training,
                           const std::vector<PackedImage>& train, CropRequest request,
                           std::shared_ptr<torch::nn::Module> module, std::shared_ptr<torch::nn::Module> average)
    : training_(training),
      train_(train),
      request_(std::move(request)),
      module_(std::move(module)),
      average_(std::move(average)),
      checkpoint_(name) {
  request_.side = training.crop, request_.batch = training.batch, request_.seed = training.seed;
  request_.light_strength = training.light_strength;
  optimizer_ = std::make_unique<torch::optim::AdamW>(
      module_->parameters(), torch::optim::AdamWOptions(training.learning_rate).weight_decay(training.weight_decay));
  checkpoint_.config_json = training.config_json;
  checkpoint_.Add("module", module_.get());
  checkpoint_.Add("average", average_.get());
  checkpoint_.Add("optimizer", optimizer_.get());
}

void ImageTrainer::Begin(int first_step) {
  batches_ = std::make_unique<Prefetcher<CropBatch>>(
      std::max(0, training_.steps - first_step),
      [this, first_step](int64_t i) { return MakeCrops(train_, request_, first_step + static_cast<int>(i)); });
}

bool ImageTrainer::Step(int step) {
  const torch::Tensor loss = LossOf(batches_->Take());
  const bool reports = (step + 1) % training_.report_every == 0 || step + 1 == training_.steps;
  // Reading a loss synchronises with the GPU: only when it is reported.
  if (reports) {
    loss_ = loss.item<double>();
    if (!std::isfinite(loss_)) return false;
  }
  SetRate(optimizer_.get(), LearningRate(step));
  optimizer_->zero_grad();
  loss.backward();
  torch::nn::utils::clip_grad_norm_(module_->parameters(), kClipNorm);
  optimizer_->step();
  AverageWeights(*module_, step + 1, training_.average_share, average_.get());
  return true;
}

TrainingOutcome ImageTrainer::Train() { return RunTraining(training_, training_.steps, &checkpoint_, this); }

double ImageTrainer::LearningRate(int step) const {
  return CosineWithWarmup(training_.learning_rate, step, training_.steps, training_.warmup_steps);
}

std::vector<TrainingFigure> ImageTrainer::Row(int done) const {
  return {{"learning_rate", LearningRate(done - 1)}, {"loss", loss_}};
}

using torch::Tensor;

constexpr int kParserIn = kParserPlanes.in;
constexpr const char* kParserTraining = "parser training";
constexpr int kMeeting = 3;  ///< distance between two pixels of different classes

/// True if another class is near, to the right or below.
bool ClassesMeet(const PackedImage& image, size_t pixel) {
  const auto width = static_cast<size_t>(image.width);
  const uint8_t own = image.truth[pixel];
  const auto other = [&](size_t at) { return image.truth[at] != 0 && image.truth[at] != own; };
  return own != 0 && ((pixel % width + kMeeting < width && other(pixel + kMeeting)) ||
                      (pixel + kMeeting * width < image.pixels() && other(pixel + kMeeting * width)));
}

ImageUnetModule SeededParser(const TrainParserOptions& options) {
  torch::manual_seed(options.seed);
  ImageUnetModule module(kParserPlanes);
  module->to(NeuralDevice());
  return module;
}

/// Converts labels of B×H×W bytes to classes from 0; −1 without a label or outside the mask.
Tensor ClassesOf(const Tensor& labels, const Tensor& planes) {
  const Tensor masked = planes.select(1, PersonPlane::kAlpha) > 0.5;
  return torch::where(masked, labels.to(torch::kLong) - 1, -torch::ones_like(labels, torch::kLong));
}

class ParserTrainer : public ImageTrainer {
 public:
  ParserTrainer(const std::vector<PackedImage>& train, const std::vector<PackedImage>& validation,
                const TrainParserOptions& options, ImageUnetModule module, ImageUnetModule average)
      : ImageTrainer("clothes parser", options, train, {kParserIn, ParserTruth::kCount, 0, 0, 1, 1, ClassesMeet},
                     module.ptr(), average.ptr()),
        validation_(validation),
        unpacked_(kParserIn),
        module_(std::move(module)),
        average_(std::move(average)) {}

  TrainParserResult Run() {
    TrainParserResult result;
    const TrainingOutcome outcome = Train();
    result.summary = summary_;
    static_cast<TrainingOutcome&>(result.summary) = outcome;
    result.weights.network = ExportImageUnet(average_);
    return result;
  }

  [[nodiscard]] bool HasValidation() const override { return !validation_.empty(); }

  void Validate(int, bool) override {
    const torch::NoGradGuard no_grad;
    ClassOverlap parsed(1 + kParserClasses), of_body(1 + kParserClasses);
    for (const PackedImage& image : validation_) {
      const auto [planes, truth] = unpacked_(BytesOf(image, kParserIn, ParserTruth::kCount));
      const std::vector<uint8_t> predicted = HostValues<uint8_t>(average_(planes).argmax(1));
      const std::vector<float> classes = HostValues<float>(ClassesOf(truth.select(1, ParserTruth::kLabel), planes));
      for (size_t i = 0; i < classes.size(); ++i) {
        if (classes[i] < 0) continue;
        const size_t true_label = 1 + static_cast<size_t>(classes[i]);
        parsed.Add(size_t{1} + predicted[i], true_label);
        of_body.Add(size_t{image.truth[ParserTruth::kBodyLabel * image.pixels() + i]}, true_label);
      }
    }
    summary_.mean_iou = parsed.MeanIou(true), summary_.body_mean_iou = of_body.MeanIou(true);
    summary_.iou.clear(), summary_.body_iou.clear();
    for (int k = 1; k <= kParserClasses; ++k) {
      summary_.iou.push_back(parsed.Iou(k)), summary_.body_iou.push_back(of_body.Iou(k));
    }
  }

  [[nodiscard]] std::vector<TrainingFigure> ScoreRow() const override {
    return {{"mean_iou", summary_.mean_iou}, {"body_mean_iou", summary_.body_mean_iou}};
  }
  [[nodiscard]] std::vector<TrainingFigure> Figures() const override {
    return {{"loss", loss()}, {"IoU", summary_.mean_iou}};
  }

 private:
  Tensor LossOf(const CropBatch& batch) override {
    auto [planes, truth] = unpacked_(batch.bytes);
    planes = torch::cat({Lit(planes.narrow(1, 0, 3), OnDevice(batch.lights)), planes.narrow(1, 3, kParserIn - 3)}, 1);
    const Tensor classes = ClassesOf(truth.select(1, ParserTruth::kLabel), planes);
    const Tensor counted = (classes >= 0).to(torch::kFloat);
    const Tensor logs = torch::log_softmax(module_(planes), 1).gather(1, classes.clamp_min(0).unsqueeze(1)).squeeze(1);
    return -(logs * counted).sum() / counted.sum().clamp_min(1);
  }

  const std::vector<PackedImage>& validation_;
  const PlaneUnpacker unpacked_;
  ImageUnetModule module_, average_;
  TrainParserSummary summary_;
};

}  // namespace

TrainParserResult TrainParser(const std::vector<PackedImage>& train, const std::vector<PackedImage>& validation,
                              const TrainParserOptions& options) {
  std::string why;
  BODYLOOM_CHECK(IsValidImageTraining(options, &why), kParserTraining, ": ", why);
  BODYLOOM_CHECK(!train.empty(), kParserTraining, ": no image to train on");
  for (const PackedImage& image : train) CheckImage(image, kParserIn, ParserTruth::kCount, kParserTraining);
  for (const PackedImage& image : validation) {
    CheckImage(image, kParserIn, ParserTruth::kCount, kParserTraining);
  }
  StartNeuralRuntime(options.num_threads);
  UseNeuralDevice(options.device);
  return ParserTrainer(train, validation, options, SeededParser(options), SeededParser(options)).Run();
}

}  // namespace bodyloom
