// SPDX-License-Identifier: Apache-2.0
#include "neural/training/renderer_trainer.h"

#include <cmath>
#include <cstring>

#include "geometry/base/check.h"
#include "neural/training/optimizers.h"

namespace bodyloom {

using torch::Tensor;

namespace {

/// Seeds LibTorch's generator before any random number is drawn.
const TrainingRun& Seeded(const TrainingRun& run) {
  StartNeuralRuntime(run.num_threads);
  UseNeuralDevice(run.device);
  torch::manual_seed(run.seed);
  return run;
}

/// Index of a loss; the number of losses if there is none of that name.
size_t PlaceOfLoss(const std::vector<TrainingFigure>& losses, const char* name) {
  size_t place = 0;
  while (place < losses.size() && std::strcmp(losses[place].name, name) != 0) ++place;
  return place;
}

}  // namespace

RendererTrainer::RendererTrainer(const TrainingRun& run, int total_steps, const std::string& identity,
                                 std::initializer_list<const char*> losses, std::initializer_list<const char*> told)
    : checkpoint_(identity), run_(Seeded(run)), total_steps_(total_steps), told_(told.begin(), told.end()) {
  checkpoint_.config_json = run.config_json;
  for (const char* loss : losses) losses_.push_back({loss});
}

bool RendererTrainer::Step(int step) {
  for (const auto& [optimizer, rate] : optimizers_) SetRate(optimizer.get(), rate * RateShare(step));
  for (TrainingFigure& loss : losses_) loss.value = 0;
  return Learn(step);
}

std::vector<TrainingFigure> RendererTrainer::Row(int done) const {
  std::vector<TrainingFigure> row = {{"learning_rate", optimizers_.front().second * RateShare(done - 1)}};
  row.insert(row.end(), losses_.begin(), losses_.end());
  return row;
}

std::vector<TrainingFigure> RendererTrainer::Figures() const {
  std::vector<TrainingFigure> figures = {{"loss", total_}};
  for (const std::string& name : told_) figures.push_back(losses_[PlaceOfLoss(losses_, name.c_str())]);
  if (!std::isnan(ValidationPsnr())) figures.push_back({"validation", ValidationPsnr(), " dB"});
  return figures;
}

double RendererTrainer::RateShare(int step) const { return LinearDecayOverLastHalf(1, step, total_steps_); }

void RendererTrainer::AddJudge(std::shared_ptr<torch::nn::Module> discriminator) {
  discriminator_ = std::move(discriminator);
  checkpoint_.Add("discriminator", discriminator_.get());
}

torch::optim::Adam* RendererTrainer::AddOptimizer(const char* name, const torch::nn::Module& module, double rate) {
  Adam* optimizer = optimizers_.emplace_back(MakeAdam(module, rate), rate).first.get();
  checkpoint_.Add(name, optimizer);
  return optimizer;
}

RendererTrainer::SeenPair RendererTrainer::See(const Tensor& image, const Tensor& truth) {
  SeenPair seen;
  {
    const torch::NoGradGuard no_grad;
    seen.truth = vgg_(truth);
  }
  seen.image = vgg_(image);
  return seen;
}

void RendererTrainer::Note(const char* loss, double value) {
  const size_t place = PlaceOfLoss(losses_, loss);
  BODYLOOM_CHECK(place < losses_.size(), "training: no loss \"", loss, "\"");
  losses_[place].value = value;
}

double RendererTrainer::Noted(const char* loss) const { return losses_.at(PlaceOfLoss(losses_, loss)).value; }

void RendererTrainer::Add(const char* name, double weight, const Tensor& loss, Tensor* total) {
  Note(name, loss.item<double>());
  *total = total->defined() ? *total + weight * loss : weight * loss;
}

bool RendererTrainer::LearnToJudge(const Tensor& loss, Adam* optimizer) {
  const double value = loss.item<double>();
  Note("discriminator", value);
  if (!std::isfinite(value)) return false;
  optimizer->zero_grad();
  loss.backward();
  optimizer->step();
  return true;
}

void RendererTrainer::OnlyJudge() { RequireGradients(discriminator_.get(), false); }

bool RendererTrainer::Descend(const Tensor& total, std::initializer_list<Adam*> optimizers) {
  total_ = total.item<double>();
  if (PlaceOfLoss(losses_, "loss") < losses_.size()) Note("loss", total_);
  double sum = total_;
  for (const TrainingFigure& loss : losses_) sum += loss.value;
  if (!std::isfinite(sum)) return false;  // a step would make the weights not finite
  for (Adam* optimizer : optimizers) optimizer->zero_grad();
  total.backward();
  RequireGradients(discriminator_.get(), true);
  for (Adam* optimizer : optimizers) optimizer->step();
  return true;
}

RendererTraining RendererTrainer::Train() {
  RendererTraining training;
  static_cast<TrainingOutcome&>(training) = RunTraining(run_, total_steps_, &checkpoint_, this);
  training.losses_off = losses_off_;
  training.perceptual_random_features = vgg_->has_random_features;
  training.checkpoint = CheckpointPath(run_.run_dir);
  return training;
}

}  // namespace bodyloom
