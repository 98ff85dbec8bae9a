// SPDX-License-Identifier: Apache-2.0
#include "neural/parser/image_trainer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "neural/training/optimizers.h"

namespace bodyloom {
namespace {

constexpr double kClipNorm = 1;

}  // namespace

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

}  // namespace bodyloom
