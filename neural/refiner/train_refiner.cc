// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/refiner/train_refiner.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/in_range.h"
#include "bodyloom/geometry/base/prefetcher.h"
#include "bodyloom/geometry/base/split_mix.h"
#include "bodyloom/neural/device.h"
#include "bodyloom/neural/losses/image_losses.h"
#include "bodyloom/neural/losses/perceptual_loss.h"
#include "bodyloom/neural/networks/vgg.h"
#include "bodyloom/neural/refiner/refiner_module.h"
#include "bodyloom/neural/runtime.h"
#include "bodyloom/neural/training/adam.h"
#include "bodyloom/neural/training/schedules.h"
#include "bodyloom/neural/training/training_loop.h"
#include "bodyloom/neural/training/weight_average.h"

namespace bodyloom {
namespace {

using torch::Tensor;

constexpr int kPlanes = PersonPlane::kCount, kTruth = 4;
constexpr int kFeatureDivisor = 2;  ///< of the random-feature substitute's channels
constexpr int kTries = 64;          ///< to find a pixel that was drawn wrongly
const std::vector<std::string> kRefinerColumns = {"learning_rate", "loss",          "image",          "alpha",
                                                  "perceptual",    "drawn_psnr_db", "refined_psnr_db"};

/// Bytes of planes and truth, B × (12 + 4) × side × side, and a background colour and a light each.
struct CropBatch {
  Tensor bytes, backgrounds;
  Tensor lights;  ///< B × 3 × 3: colours are multiplied by it
};

/// A change of a picture's colours, row by row: brightness, each channel's own gain, and how much of the other channels
/// comes in (saturation, hue).
void DrawLight(uint64_t hash, double strength, float* matrix) {
  const auto next = [&hash] {
    hash = Mix(hash);
    return 2 * UniformOf(hash) - 1;
  };
  const double brightness = std::exp(0.5 * strength * next());
  for (int r = 0; r < 3; ++r) {
    const double gain = brightness * std::exp(0.3 * strength * next());
    double others = 0;
    for (int c = 0; c < 3; ++c) {
      if (c == r) continue;
      const double share = 0.3 * strength * next();
      matrix[3 * r + c] = static_cast<float>(gain * share);
      others += share;
    }
    matrix[3 * r + r] = static_cast<float>(gain * (1 - others));
  }
}

/// Planes 0, 1, 2 of B×C×H×W by the lights, within 0 and 1.
Tensor Lit(const Tensor& colours, const Tensor& lights) {
  return torch::clamp(torch::einsum("brc,bchw->brhw", {lights, colours}), 0, 1);
}

/// Where in a picture a crop begins, one coordinate: the crop lies inside or, where the picture is smaller, around it.
int CropStart(int centre, int side, int size) {
  const int start = centre - side / 2;
  return size <= side ? std::clamp(start, size - side, 0) : std::clamp(start, 0, size - side);
}

/// A pixel that is drawn and should not be, or the other way about; −1 when none was met.
int64_t WrongPixel(const RefinerPicture& picture, uint64_t hash) {
  const size_t pixels = picture.pixels();
  for (int i = 0; i < kTries; ++i) {
    hash = Mix(hash);
    const size_t p = hash % pixels;
    const int drawn = picture.planes[PersonPlane::kAlpha * pixels + p], truth = picture.truth[3 * pixels + p];
    if (std::abs(drawn - truth) > 127) return static_cast<int64_t>(p);
  }
  return -1;
}

void CopyCrop(const std::vector<uint8_t>& from, int planes, const RefinerPicture& picture, int x0, int y0, int side,
              uint8_t* to) {
  for (int p = 0; p < planes; ++p) {
    for (int y = std::max(0, -y0); y < std::min(side, picture.height - y0); ++y) {
      const int x = std::max(0, -x0), end = std::min(side, picture.width - x0);
      const size_t row = p * picture.pixels() + static_cast<size_t>(y0 + y) * picture.width;
      std::memcpy(to + (static_cast<size_t>(p) * side + y) * side + x, from.data() + row + x0 + x, end - x);
    }
  }
}

/// Bytes as they are where nothing is drawn.
void FillEmpty(int side, uint8_t* to) {
  const size_t pixels = static_cast<size_t>(side) * side;
  for (int p = 0; p < kPlanes; ++p) std::memset(to + p * pixels, PackPlane(p, 0), pixels);
  std::memset(to + kPlanes * pixels, 0, kTruth * pixels);
}

CropBatch MakeBatch(const std::vector<RefinerPicture>& pictures, const TrainRefinerOptions& options, int step) {
  const int side = options.crop;
  const size_t numbers = static_cast<size_t>(kPlanes + kTruth) * side * side;
  CropBatch batch = {torch::empty({options.batch, kPlanes + kTruth, side, side}, torch::kUInt8),
                     torch::empty({options.batch, 3, 1, 1}), torch::empty({options.batch, 3, 3})};
  for (int b = 0; b < options.batch; ++b) {
    uint64_t hash = Mix(Mix(options.seed) ^ (static_cast<uint64_t>(step) * options.batch + b));
    const RefinerPicture& picture = pictures[hash % pictures.size()];
    hash = Mix(hash);
    int64_t centre = hash % 2 == 0 ? WrongPixel(picture, hash) : -1;
    hash = Mix(hash);
    if (centre < 0) centre = static_cast<int64_t>(hash % picture.pixels());
    hash = Mix(hash);
    const int jitter = side / 2, dx = static_cast<int>(hash % jitter) - jitter / 2,
              dy = static_cast<int>((hash >> 32) % jitter) - jitter / 2;
    const int x0 = CropStart(static_cast<int>(centre % picture.width) + dx, side, picture.width);
    const int y0 = CropStart(static_cast<int>(centre / picture.width) + dy, side, picture.height);
    uint8_t* to = batch.bytes.data_ptr<uint8_t>() + b * numbers;
    FillEmpty(side, to);
    CopyCrop(picture.planes, kPlanes, picture, x0, y0, side, to);
    CopyCrop(picture.truth, kTruth, picture, x0, y0, side, to + static_cast<size_t>(kPlanes) * side * side);
    for (int c = 0; c < 3; ++c) {
      hash = Mix(hash);
      batch.backgrounds.data_ptr<float>()[3 * b + c] = static_cast<float>(UniformOf(hash));
    }
    DrawLight(Mix(hash), options.light_strength, batch.lights.data_ptr<float>() + 9 * b);
  }
  return batch;
}

struct PlanesAndTruth {
  Tensor planes, truth;
};

/// Bytes to numbers, on the networks' device.
class Unpacker {
 public:
  Unpacker() {
    std::vector<float> offsets, scales;
    for (int p = 0; p < kPlanes; ++p) {
      offsets.push_back(PackingOf(p).offset);
      scales.push_back(PackingOf(p).scale);
    }
    offsets_ = OnDevice(torch::tensor(offsets)).view({1, kPlanes, 1, 1});
    scales_ = OnDevice(torch::tensor(scales)).view({1, kPlanes, 1, 1});
  }

  [[nodiscard]] PlanesAndTruth operator()(const Tensor& bytes) const {
    const Tensor numbers = OnDevice(bytes).to(torch::kFloat);
    return {(numbers.narrow(1, 0, kPlanes) - offsets_) / scales_, numbers.narrow(1, kPlanes, kTruth) / 255};
  }

 private:
  Tensor offsets_, scales_;
};

void CheckPicture(const RefinerPicture& picture) {
  BODYLOOM_CHECK(picture.width > 0 && picture.height > 0 && picture.width % kRefinerMultiple == 0 &&
                     picture.height % kRefinerMultiple == 0 && picture.planes.size() == kPlanes * picture.pixels() &&
                     picture.truth.size() == kTruth * picture.pixels(),
                 "refiner training: a picture of ", picture.width, "x", picture.height, " pixels with ",
                 picture.planes.size(), " bytes of planes and ", picture.truth.size(), " of truth");
}

class RefinerTrainer : public TrainedSystem {
 public:
  RefinerTrainer(const std::vector<RefinerPicture>& train, const std::vector<RefinerPicture>& validation,
                 const TrainRefinerOptions& options)
      : train_(train), validation_(validation), options_(options), checkpoint_("picture refiner") {
    torch::manual_seed(options.seed);
    module_ = RefinerModule();
    average_ = RefinerModule();
    ImportRefiner(ExportRefiner(module_), &average_);
    module_->to(NeuralDevice());
    average_->to(NeuralDevice());
    vgg_ = MakeFeatureNetwork(FeatureTrunk::kVgg16, {"relu1_2", "relu2_2", "relu3_3"}, options.vgg16, kFeatureDivisor);
    optimizer_ = std::make_unique<torch::optim::AdamW>(
        module_->parameters(), torch::optim::AdamWOptions(options.learning_rate).weight_decay(options.weight_decay));
    checkpoint_.config_json = options.config_json;
    checkpoint_.Add("module", module_.ptr().get());
    checkpoint_.Add("average", average_.ptr().get());
    checkpoint_.Add("optimizer", optimizer_.get());
  }

  TrainRefinerResult Run() {
    TrainRefinerResult result;
    static_cast<TrainingOutcome&>(result.summary) =
        RunTraining(options_, options_.steps, kRefinerColumns, &checkpoint_, this);
    result.summary.drawn_psnr_db = drawn_psnr_db_;
    result.summary.refined_psnr_db = refined_psnr_db_;
    result.weights = ExportRefiner(average_);
    return result;
  }

  void Begin(int first_step) override {
    batches_ = std::make_unique<Prefetcher<CropBatch>>(
        std::max(0, options_.steps - first_step),
        [this, first_step](int64_t i) { return MakeBatch(train_, options_, first_step + static_cast<int>(i)); });
  }

  bool Step(int step) override {
    const CropBatch batch = batches_->Take();
    auto [planes, truth] = unpacked_(batch.bytes);
    const Tensor background = OnDevice(batch.backgrounds), lights = OnDevice(batch.lights);
    planes = torch::cat({Lit(planes.narrow(1, 0, 3), lights), planes.narrow(1, 3, kPlanes - 3)}, 1);
    truth = torch::cat({Lit(truth.narrow(1, 0, 3), lights), truth.narrow(1, 3, 1)}, 1);
    const Tensor person = ChangedPerson(planes, module_(planes));
    const Tensor alpha = person.narrow(1, 3, 1), true_alpha = truth.narrow(1, 3, 1);
    const Tensor drawn = person.narrow(1, 0, 3) * alpha + background * (1 - alpha);
    const Tensor wanted = truth.narrow(1, 0, 3) + background * (1 - true_alpha);
    const Tensor image = L1Loss(drawn, wanted), outline = L1Loss(alpha, true_alpha);
    const Tensor perceptual = options_.perceptual_weight > 0 ? Perceptual(drawn, wanted) : torch::zeros_like(image);
    const Tensor loss = image + options_.alpha_weight * outline + options_.perceptual_weight * perceptual;
    const bool reports = (step + 1) % options_.report_every == 0 || step + 1 == options_.steps;
    // Reading a loss waits for the card: only where somebody reads it.
    if (reports) {
      loss_ = loss.item<double>(), image_ = image.item<double>();
      outline_ = outline.item<double>(), perceptual_ = perceptual.item<double>();
      if (!std::isfinite(loss_)) return false;
    }
    SetRate(optimizer_.get(), LearningRate(step));
    optimizer_->zero_grad();
    loss.backward();
    torch::nn::utils::clip_grad_norm_(module_->parameters(), kClipNorm);
    optimizer_->step();
    AverageWeights(*module_, step + 1, options_.average_share, average_.ptr().get());
    return true;
  }

  [[nodiscard]] bool HasValidation() const override { return !validation_.empty(); }

  void Validate(int, bool) override {
    const torch::NoGradGuard no_grad;
    double drawn = 0, refined = 0, count = 0;
    for (const RefinerPicture& picture : validation_) {
      const Tensor bytes = torch::empty({1, kPlanes + kTruth, picture.height, picture.width}, torch::kUInt8);
      std::memcpy(bytes.data_ptr<uint8_t>(), picture.planes.data(), picture.planes.size());
      std::memcpy(bytes.data_ptr<uint8_t>() + picture.planes.size(), picture.truth.data(), picture.truth.size());
      const PlanesAndTruth numbers = unpacked_(bytes);
      const Tensor &planes = numbers.planes, &truth = numbers.truth;
      const Tensor person = ChangedPerson(planes, average_(planes));
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

  [[nodiscard]] std::vector<double> Row(int done) const override {
    return {LearningRate(done - 1), loss_, image_, outline_, perceptual_};
  }
  [[nodiscard]] std::vector<double> ScoreRow() const override { return {drawn_psnr_db_, refined_psnr_db_}; }

  bool Report(int done, double seconds) override {
    return !options_.progress ||
           options_.progress({done, options_.steps, loss_, image_, drawn_psnr_db_, refined_psnr_db_, seconds});
  }

 private:
  static constexpr double kClipNorm = 1;

  Tensor Perceptual(const Tensor& drawn, const Tensor& wanted) {
    std::vector<Tensor> features;
    {
      const torch::NoGradGuard no_grad;
      features = vgg_(wanted);
    }
    return PerceptualLoss(vgg_(drawn), features);
  }

  [[nodiscard]] double LearningRate(int step) const {
    return CosineWithWarmup(options_.learning_rate, step, options_.steps, options_.warmup_steps);
  }

  const std::vector<RefinerPicture>&train_, &validation_;
  const TrainRefinerOptions& options_;
  const Unpacker unpacked_;
  RefinerModule module_{nullptr}, average_{nullptr};
  FeatureNetwork vgg_{nullptr};
  std::unique_ptr<torch::optim::AdamW> optimizer_;
  Checkpoint checkpoint_;
  double loss_ = 0, image_ = 0, outline_ = 0, perceptual_ = 0;  ///< of the last step that was reported
  double drawn_psnr_db_ = 0, refined_psnr_db_ = 0;
  std::unique_ptr<Prefetcher<CropBatch>> batches_;  ///< last: its thread uses the rest
};

}  // namespace

bool TrainRefinerOptions::IsValid(std::string* why) const {
  const InRange in_range(why);
  if (crop % kRefinerMultiple != 0) {
    if (why != nullptr) *why = Concatenate("crop is ", crop, ", expected a multiple of ", kRefinerMultiple);
    return false;
  }
  return IsValidRun(*this, why) && in_range("crop", crop, kRefinerMultiple, 4096) &&
         in_range("batch", batch, 1, 4096) && in_range("learning_rate", learning_rate, 0, 1) &&
         in_range("warmup_steps", warmup_steps, 0, 1e8) && in_range("weight_decay", weight_decay, 0, 1) &&
         in_range("alpha_weight", alpha_weight, 0, 1e3) && in_range("perceptual_weight", perceptual_weight, 0, 1e3) &&
         in_range("average_share", average_share, 1e-6, 0.5) && in_range("light_strength", light_strength, 0, 1);
}

TrainRefinerResult TrainRefiner(const std::vector<RefinerPicture>& train, const std::vector<RefinerPicture>& validation,
                                const TrainRefinerOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "refiner training: ", why);
  BODYLOOM_CHECK(!train.empty(), "refiner training: no picture to train on");
  for (const RefinerPicture& picture : train) CheckPicture(picture);
  for (const RefinerPicture& picture : validation) CheckPicture(picture);
  StartNeuralRuntime(options.num_threads);
  UseNeuralDevice(options.device);
  return RefinerTrainer(train, validation, options).Run();
}

}  // namespace bodyloom
