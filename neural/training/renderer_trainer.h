// SPDX-License-Identifier: Apache-2.0
/// Base class of the renderers' trainers: generator networks, a discriminator and a feature network for the perceptual
/// loss; Adam with one learning rate schedule for all; losses by name, as in metrics.csv. A renderer adds its networks,
/// batches, losses and validation. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <initializer_list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "neural/networks/vgg.h"
#include "neural/training/checkpoint.h"
#include "neural/training/training_loop.h"

namespace bodyloom {

class RendererTrainer : public TrainedSystem {
 public:
  RendererTrainer(const RendererTrainer&) = delete;
  RendererTrainer& operator=(const RendererTrainer&) = delete;
  bool Step(int step) final;
  /// The learning rate, then the losses of the last step in the constructor's order; 0: not computed.
  [[nodiscard]] std::vector<TrainingFigure> Row(int done) const override;
  /// "loss", the losses named in `told`, and "validation" after the first one.
  [[nodiscard]] std::vector<TrainingFigure> Figures() const override;

 protected:
  using Adam = torch::optim::Adam;

  /// Starts the runtime and LibTorch's random generator. `run` must outlive this; `identity` is the checkpoint's;
  /// `losses`: columns of metrics.csv, including "loss" if the sum is a column. `told`: losses also reported to the
  /// caller.
  RendererTrainer(const TrainingRun& run, int total_steps, const std::string& identity,
                  std::initializer_list<const char*> losses, std::initializer_list<const char*> told);

  /// Performs the step's optimisation by LearnToJudge and Descend; false when a loss is not finite.
  virtual bool Learn(int step) = 0;
  /// PSNR of the last validation, NaN before the first.
  [[nodiscard]] virtual double ValidationPsnr() const = 0;
  /// Factor of all learning rates: 1 for the first half, then decreasing to 0.
  [[nodiscard]] virtual double RateShare(int step) const;

  /// Adds the networks to the checkpoint: modules first, then their optimizers, the order in files of earlier versions.
  void AddJudge(std::shared_ptr<torch::nn::Module> discriminator);
  Adam* AddOptimizer(const char* name, const torch::nn::Module& module, double rate);

  /// Features of an image and of the true one, which needs no gradient.
  struct SeenPair {
    std::vector<torch::Tensor> image, truth;
  };
  [[nodiscard]] SeenPair See(const torch::Tensor& image, const torch::Tensor& truth);

  void Note(const char* loss, double value);
  [[nodiscard]] double Noted(const char* loss) const;
  /// *total += weight · loss; logs the loss without its weight.
  void Add(const char* name, double weight, const torch::Tensor& loss, torch::Tensor* total);
  /// Performs a step of the discriminator; returns false without a step when its loss is not finite.
  bool LearnToJudge(const torch::Tensor& loss, Adam* optimizer);
  /// Disables gradients of the discriminator's parameters until Descend.
  void OnlyJudge();
  /// Performs a step on the sum of all losses; returns false without a step when a logged loss is not finite.
  bool Descend(const torch::Tensor& total, std::initializer_list<Adam*> optimizers);

  RendererTraining Train();

  Checkpoint checkpoint_;
  FeatureNetwork vgg_{nullptr};
  std::vector<std::string> losses_off_;

 private:
  const TrainingRun& run_;
  int total_steps_;
  std::vector<TrainingFigure> losses_;
  std::vector<std::string> told_;
  double total_ = 0;
  std::shared_ptr<torch::nn::Module> discriminator_;
  std::vector<std::pair<std::unique_ptr<Adam>, double>> optimizers_;  ///< optimizers and their maximum rates
};

}  // namespace bodyloom
