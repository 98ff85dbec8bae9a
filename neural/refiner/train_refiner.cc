// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/refiner/train_refiner.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/in_range.h"
#include "bodyloom/neural/device.h"
#include "bodyloom/neural/losses/image_losses.h"
#include "bodyloom/neural/losses/perceptual_loss.h"
#include "bodyloom/neural/networks/vgg.h"
#include "bodyloom/neural/pictures/picture_crops.h"
#include "bodyloom/neural/pictures/picture_trainer.h"
#include "bodyloom/neural/refiner/refiner_module.h"
#include "bodyloom/neural/runtime.h"

namespace bodyloom {
namespace {

using torch::Tensor;

constexpr int kPlanes = PersonPlane::kCount, kTruth = 4;
constexpr int kFeatureDivisor = 2;  ///< of the random-feature substitute's channels
constexpr const char* kWhat = "refiner training";
const std::vector<std::string> kRefinerColumns = {"learning_rate", "loss",          "image",          "alpha",
                                                  "perceptual",    "drawn_psnr_db", "refined_psnr_db"};

/// Drawn and should not be, or the other way about.
bool IsDrawnWrongly(const PackedPicture& picture, size_t pixel) {
  const size_t pixels = picture.pixels();
  const int drawn = picture.planes[PersonPlane::kAlpha * pixels + pixel], truth = picture.truth[3 * pixels + pixel];
  return std::abs(drawn - truth) > 127;
}

/// A seeded module on the networks' device, and its average with the same numbers.
RefinerModule SeededRefiner(const TrainRefinerOptions& options) {
  torch::manual_seed(options.seed);
  RefinerModule module(options.moves_outline);
  module->to(NeuralDevice());
  return module;
}

class RefinerTrainer : public PictureTrainer {
 public:
  RefinerTrainer(const std::vector<PackedPicture>& train, const std::vector<PackedPicture>& validation,
                 const TrainRefinerOptions& options, RefinerModule module, RefinerModule average)
      : PictureTrainer("picture refiner", options, train, {kPlanes, kTruth, 0, 0, 1, 1, IsDrawnWrongly}, module.ptr(),
                       average.ptr()),
        validation_(validation),
        options_(options),
        unpacked_(kPlanes),
        module_(std::move(module)),
        average_(std::move(average)),
        vgg_(MakeFeatureNetwork(FeatureTrunk::kVgg16, {"relu1_2", "relu2_2", "relu3_3"}, options.vgg16,
                                kFeatureDivisor)) {}

  TrainRefinerResult Run() {
    TrainRefinerResult result;
    static_cast<TrainingOutcome&>(result.summary) = Train(kRefinerColumns);
    result.summary.drawn_psnr_db = drawn_psnr_db_;
    result.summary.refined_psnr_db = refined_psnr_db_;
    result.weights.network = ExportPictureUnet(average_->network);
    result.weights.moves_outline = options_.moves_outline;
    return result;
  }

  [[nodiscard]] bool HasValidation() const override { return !validation_.empty(); }

  void Validate(int, bool) override {
    const torch::NoGradGuard no_grad;
    double drawn = 0, refined = 0, count = 0;
    for (const PackedPicture& picture : validation_) {
      const auto [planes, bytes] = unpacked_(BytesOf(picture, kPlanes, kTruth));
      const Tensor truth = bytes.to(torch::kFloat) / 255, person = ChangedPerson(planes, average_(planes));
      const Tensor counted = torch::maximum(planes.narrow(1, 3, 1), truth.narrow(1, 3, 1)) > 0;
      const auto error = [&](const Tensor& planes_of) {
        const Tensor shown = planes_of.narrow(1, 0, 3) * planes_of.narrow(1, 3, 1);
        return ((shown - truth.narrow(1, 0, 3)).square() * counted).sum().item<double>();
      };
      drawn += error(planes);
      refined += error(person);
      count += 3 * counted.sum().item<double>();
    }
    const auto decibels = [count](double sum) { return -10 * std::log10(std::max(1e-12, sum / std::max(1.0, count))); };
    drawn_psnr_db_ = decibels(drawn);
    refined_psnr_db_ = decibels(refined);
  }

  [[nodiscard]] std::vector<double> ScoreRow() const override { return {drawn_psnr_db_, refined_psnr_db_}; }

  bool Report(int done, double seconds) override {
    return !options_.progress || options_.progress({done, options_.steps, loss(), parts().empty() ? 0 : parts()[0],
                                                    drawn_psnr_db_, refined_psnr_db_, seconds});
  }

 private:
  Losses LossesOf(const CropBatch& batch) override {
    auto [planes, bytes] = unpacked_(batch.bytes);
    Tensor truth = bytes.to(torch::kFloat) / 255;
    const Tensor background = OnDevice(batch.backgrounds), lights = OnDevice(batch.lights);
    planes = torch::cat({Lit(planes.narrow(1, 0, 3), lights), planes.narrow(1, 3, kPlanes - 3)}, 1);
    truth = torch::cat({Lit(truth.narrow(1, 0, 3), lights), truth.narrow(1, 3, 1)}, 1);
    const Tensor person = ChangedPerson(planes, module_(planes));
    const Tensor alpha = person.narrow(1, 3, 1), true_alpha = truth.narrow(1, 3, 1);
    const Tensor drawn = person.narrow(1, 0, 3) * alpha + background * (1 - alpha);
    const Tensor wanted =
        options_.moves_outline
            ? truth.narrow(1, 0, 3) + background * (1 - true_alpha)
            : (truth.narrow(1, 0, 3) + planes.narrow(1, 0, 3) * (1 - true_alpha)) * alpha + background * (1 - alpha);
    const Tensor image = L1Loss(drawn, wanted), outline = L1Loss(alpha, true_alpha);
    const Tensor perceptual = options_.perceptual_weight > 0 ? Perceptual(drawn, wanted) : torch::zeros_like(image);
    return {image + options_.alpha_weight * outline + options_.perceptual_weight * perceptual,
            {image, outline, perceptual}};
  }

  Tensor Perceptual(const Tensor& drawn, const Tensor& wanted) {
    std::vector<Tensor> features;
    {
      const torch::NoGradGuard no_grad;
      features = vgg_(wanted);
    }
    return PerceptualLoss(vgg_(drawn), features);
  }

  const std::vector<PackedPicture>& validation_;
  const TrainRefinerOptions& options_;
  const PlaneUnpacker unpacked_;
  RefinerModule module_, average_;
  FeatureNetwork vgg_{nullptr};
  double drawn_psnr_db_ = 0, refined_psnr_db_ = 0;
};

}  // namespace

bool TrainRefinerOptions::IsValid(std::string* why) const {
  const InRange in_range(why);
  return IsValidPictureTraining(*this, why) && in_range("alpha_weight", alpha_weight, 0, 1e3) &&
         in_range("perceptual_weight", perceptual_weight, 0, 1e3);
}

TrainRefinerResult TrainRefiner(const std::vector<PackedPicture>& train, const std::vector<PackedPicture>& validation,
                                const TrainRefinerOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), kWhat, ": ", why);
  BODYLOOM_CHECK(!train.empty(), kWhat, ": no picture to train on");
  for (const PackedPicture& picture : train) CheckPicture(picture, kPlanes, kTruth, kWhat);
  for (const PackedPicture& picture : validation) CheckPicture(picture, kPlanes, kTruth, kWhat);
  StartNeuralRuntime(options.num_threads);
  UseNeuralDevice(options.device);
  return RefinerTrainer(train, validation, options, SeededRefiner(options), SeededRefiner(options)).Run();
}

}  // namespace bodyloom
