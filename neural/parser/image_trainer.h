// SPDX-License-Identifier: Apache-2.0
/// Common training of U-Nets on images: crops (image_crops.h) prefetched by a thread, AdamW with a cosine schedule,
/// averaged weights (neural/training/optimizers.h). Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <memory>
#include <string>
#include <vector>

#include "geometry/base/prefetcher.h"
#include "neural/parser/image_crops.h"
#include "neural/parser/packed_image.h"
#include "neural/training/checkpoint.h"
#include "neural/training/training_loop.h"

namespace bodyloom {

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

}  // namespace bodyloom
