// SPDX-License-Identifier: Apache-2.0
#include "neural/parser/train_parser.h"

#include <cstdint>
#include <utility>

#include "geometry/base/check.h"
#include "neural/base/device.h"
#include "neural/base/runtime.h"
#include "neural/metrics/pixel_metrics.h"
#include "neural/networks/image_unet_module.h"
#include "neural/parser/image_crops.h"
#include "neural/parser/image_trainer.h"

namespace bodyloom {
namespace {

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
