// SPDX-License-Identifier: Apache-2.0
/// What the training of every renderer has in common: networks that draw, beside a discriminator that judges and a
/// feature network that compares; Adam with one course of the learning rate for all; losses by name, as metrics.csv has
/// them. A renderer adds its networks, batches, losses and validation. Internal: includes LibTorch.
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
  /// "loss", the losses that `told` names, and "validation" once there was one.
  [[nodiscard]] std::vector<TrainingFigure> Figures() const override;

 protected:
  using Adam = torch::optim::Adam;

  /// Starts the runtime and LibTorch's random generator. `run` must outlive this; `identity` is the checkpoint's;
  /// `losses` are columns of metrics.csv, among them "loss" where the sum has one. `told`: to the caller as well.
  RendererTrainer(const TrainingRun& run, int total_steps, const std::string& identity,
                  std::initializer_list<const char*> losses, std::initializer_list<const char*> told);

  /// The step's losses, by LearnToJudge and Descend; false when one of them is not finite.
  virtual bool Learn(int step) = 0;
  /// PSNR of the last validation, NaN before the first.
  [[nodiscard]] virtual double ValidationPsnr() const = 0;
  /// Of all learning rates: 1 for the first half, then falling to 0.
  [[nodiscard]] virtual double RateShare(int step) const;

  /// Adds the networks to the checkpoint: modules first, then their optimizers, as files of earlier versions have them.
  void AddJudge(std::shared_ptr<torch::nn::Module> discriminator);
  Adam* AddOptimizer(const char* name, const torch::nn::Module& module, double rate);

  /// Of a picture and of the true one, which needs no gradient.
  struct SeenPair {
    std::vector<torch::Tensor> picture, truth;
  };
  [[nodiscard]] SeenPair See(const torch::Tensor& picture, const torch::Tensor& truth);

  void Note(const char* loss, double value);
  [[nodiscard]] double Noted(const char* loss) const;
  /// *total += weight · loss; noted without its weight.
  void Add(const char* name, double weight, const torch::Tensor& loss, torch::Tensor* total);
  /// A step of the discriminator by its loss; false, and none is taken, when that is not finite.
  bool LearnToJudge(const torch::Tensor& loss, Adam* optimizer);
  /// The discriminator's logits are to be taken without its own gradients, until Descend.
  void OnlyJudge();
  /// A step down the sum of all losses; false, and none is taken, when one of those noted is not finite.
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
  std::vector<std::pair<std::unique_ptr<Adam>, double>> optimizers_;  ///< and their rates at the highest
};

}  // namespace bodyloom
