// SPDX-License-Identifier: Apache-2.0
#include "neural/lifter/train_lifter.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "geometry/base/check.h"
#include "geometry/base/prefetcher.h"
#include "neural/base/runtime.h"
#include "neural/lifter/lifter_module.h"
#include "neural/training/optimizers.h"
#include "neural/training/training_loop.h"

namespace bodyloom {
namespace {

using torch::Tensor;

constexpr uint64_t kValidationSeeds = uint64_t{1} << 62;
struct Batch {
  Tensor features;  ///< B×inputs×T
  LifterTargets targets;
};

Tensor Stack(const std::vector<LifterExample>& examples, std::vector<float> LifterExample::*field, const char* name,
             int64_t frames, int64_t columns) {
  const auto B = static_cast<int64_t>(examples.size());
  Tensor result = torch::empty({B, frames, columns});
  for (int64_t b = 0; b < B; ++b) {
    const std::vector<float>& values = examples[b].*field;
    BODYLOOM_CHECK(static_cast<int64_t>(values.size()) == frames * columns, "lifter training: an example has ",
                   values.size(), " numbers of ", name, ", expected ", frames, "x", columns);
    std::copy(values.begin(), values.end(), result.data_ptr<float>() + b * frames * columns);
  }
  return result;
}

Batch MakeBatch(const LifterSource& source, uint64_t first_seed, int count, const TrainLifterOptions& options) {
  std::vector<LifterExample> examples(count);
  for (int b = 0; b < count; ++b) source(first_seed + b, &examples[b]);
  const int T = options.num_frames;
  Batch batch;
  batch.features =
      Stack(examples, &LifterExample::features, "features", T, options.num_inputs).transpose(1, 2).contiguous();
  batch.targets.points =
      Stack(examples, &LifterExample::points, "points", T, 3 * LifterOutput::kPoints).reshape({count, T, -1, 3});
  batch.targets.up = Stack(examples, &LifterExample::up, "up", T, 3);
  batch.targets.contact = Stack(examples, &LifterExample::contact, "contact", T, 2);
  return batch;
}

double LearningRate(const TrainLifterOptions& options, int step) {
  return CosineWithWarmup(options.learning_rate, step, options.steps, options.warmup_steps);
}

/// Configuration that must agree with a checkpoint's.
std::string ToText(const TrainLifterOptions& options) {
  std::string text = Concatenate("lifter of ", options.num_inputs, " inputs, ", options.width, " channels, dilations");
  for (const int dilation : options.dilations) text += Concatenate(" ", dilation);
  return text + (options.muon ? ", Muon" : ", AdamW");
}

class LifterTrainer : public TrainedSystem {
 public:
  LifterTrainer(const LifterSource& train, const LifterSource& validation, const TrainLifterOptions& options)
      : train_(train), validation_(validation), options_(options), checkpoint_(ToText(options)) {
    torch::manual_seed(options.seed);
    module_ = LifterModule(options.num_inputs, options.width, options.dilations);
    average_ = LifterModule(options.num_inputs, options.width, options.dilations);
    if (options.begin_with != nullptr) ImportLifter(*options.begin_with, &module_);
    ImportLifter(ExportLifter(module_), &average_);
    std::vector<Tensor> matrices, others;
    for (const auto& item : module_->named_parameters()) {
      const bool block = item.key().rfind("block", 0) == 0 && item.value().dim() == 3;
      (block && options.muon ? matrices : others).push_back(item.value());
    }
    optimizer_ = std::make_unique<torch::optim::AdamW>(
        others, torch::optim::AdamWOptions(options.learning_rate).weight_decay(options.weight_decay));
    muon_ = std::make_unique<Muon>(matrices, Muon::Options{0.95, options.weight_decay});
    checkpoint_.Add("module", module_.ptr().get());
    checkpoint_.Add("average", average_.ptr().get());
    checkpoint_.Add("optimizer", optimizer_.get());
    for (size_t i = 0; i < muon_->momenta().size(); ++i) {
      checkpoint_.Add("momentum" + std::to_string(i), &muon_->momenta()[i]);
    }
  }

  TrainLifterResult Run() {
    TrainLifterResult result;
    static_cast<TrainingOutcome&>(result.summary) = RunTraining(options_, options_.steps, &checkpoint_, this);
    result.summary.validation_distance = distance_;
    result.summary.validation_best_distance = best_distance_;
    result.weights = ExportLifter(average_);
    return result;
  }

  void Begin(int first_step) override {
    batches_ =
        std::make_unique<Prefetcher<Batch>>(std::max(0, options_.steps - first_step), [this, first_step](int64_t i) {
          const uint64_t step = first_step + i;
          return MakeBatch(train_, (options_.seed << 40) + step * uint64_t(options_.batch), options_.batch, options_);
        });
  }

  bool Step(int step) override {
    loss_ = Learn(batches_->Take(), step);
    loss_.total = loss_.total.detach();
    return std::isfinite(loss_.distance + loss_.nll) && std::isfinite(gradient_norm_);
  }

  [[nodiscard]] bool HasValidation() const override { return options_.validation_windows > 0; }

  void Validate(int, bool) override {
    const torch::NoGradGuard no_grad;
    double distance = 0, best = 0;
    int done = 0;
    while (done < options_.validation_windows) {
      const int count = std::min(options_.batch, options_.validation_windows - done);
      const Batch batch = MakeBatch(validation_, kValidationSeeds + done, count, options_);
      const Tensor output = average_(batch.features);
      const auto mean = [&](const Tensor& points) {
        return (points - batch.targets.points).square().sum(-1).sqrt().mean().item<double>() * count;
      };
      distance += mean(LikeliestPoints(output));
      best += mean(NearestPoints(output, batch.targets.points));
      done += count;
    }
    distance_ = distance / std::max(1, done);
    best_distance_ = best / std::max(1, done);
  }

  [[nodiscard]] std::vector<TrainingFigure> Row(int done) const override {
    return {{"learning_rate", LearningRate(options_, done - 1)},
            {"loss", Total()},
            {"distance", loss_.distance},
            {"nll", loss_.nll},
            {"velocity", loss_.velocity},
            {"up", loss_.up},
            {"contact", loss_.contact},
            {"gradient_norm", gradient_norm_}};
  }

  [[nodiscard]] std::vector<TrainingFigure> ScoreRow() const override {
    return {{"validation_distance", distance_}, {"validation_best_distance", best_distance_}};
  }

  [[nodiscard]] std::vector<TrainingFigure> Figures() const override {
    std::vector<TrainingFigure> figures = {{"distance", loss_.distance}};
    if (distance_ > 0) figures.push_back({"validation", distance_});
    return figures;
  }

 private:
  /// 0 before the first step.
  [[nodiscard]] double Total() const { return loss_.total.defined() ? loss_.total.item<double>() : 0; }

  LifterLoss Learn(const Batch& batch, int step) {
    const double rate = LearningRate(options_, step);
    SetRate(optimizer_.get(), rate);
    module_->zero_grad();  // of all weights, which two optimizers share
    LifterLoss loss =
        ComputeLifterLoss(module_(batch.features), batch.targets, {options_.nll_weight, options_.velocity_weight});
    loss.total.backward();
    gradient_norm_ = torch::nn::utils::clip_grad_norm_(module_->parameters(), options_.clip_norm);
    if (!std::isfinite(gradient_norm_)) return loss;  // a step would make the weights not finite
    optimizer_->step();
    muon_->Step(rate);
    const torch::NoGradGuard no_grad;
    // Lower decay in early steps, so that the average forgets the initial weights.
    const double keep = std::min(options_.average, (1.0 + step) / (10.0 + step));
    const auto from = module_->parameters();
    const auto to = average_->parameters();
    for (size_t i = 0; i < from.size(); ++i) to[i].lerp_(from[i], 1 - keep);
    return loss;
  }

  const LifterSource &train_, &validation_;
  const TrainLifterOptions& options_;
  LifterModule module_{nullptr}, average_{nullptr};
  std::unique_ptr<torch::optim::AdamW> optimizer_;
  std::unique_ptr<Muon> muon_;
  Checkpoint checkpoint_;
  LifterLoss loss_;  ///< of the last step
  double gradient_norm_ = 0, distance_ = 0, best_distance_ = 0;
  std::unique_ptr<Prefetcher<Batch>> batches_;  ///< last: its thread uses the rest
};

}  // namespace

bool TrainLifterOptions::IsValid(std::string* why) const {
  const InRange in_range(why);
  if (device != "cpu") {
    if (why != nullptr) *why = "the lifter trains on the CPU alone, expected device cpu";
    return false;
  }
  return IsValidRun(*this, why) && in_range("num_inputs", num_inputs, 1, 4096) &&
         in_range("num_frames", num_frames, 1, 4096) && in_range("width", width, 1, 4096) &&
         in_range("batch", batch, 1, 4096) && in_range("learning_rate", learning_rate, 0, 1) &&
         in_range("average", average, 0, 1) && in_range("clip_norm", clip_norm, 0, 1e9) &&
         in_range("validation_windows", validation_windows, 0, 1e6) && in_range("seed", double(seed), 0, 1 << 20);
}

TrainLifterResult TrainLifter(const LifterSource& train, const LifterSource& validation,
                              const TrainLifterOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "lifter training: ", why);
  StartNeuralRuntime(options.num_threads);
  return LifterTrainer(train, validation, options).Run();
}

}  // namespace bodyloom
