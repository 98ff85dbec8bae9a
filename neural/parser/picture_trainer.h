// SPDX-License-Identifier: Apache-2.0
/// The steps that training of every picture U-Net has: crops (picture_crops.h) made ahead by a thread, AdamW with a
/// cosine schedule, an average of the weights (neural/training/optimizers.h). Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <memory>
#include <string>
#include <vector>

#include "geometry/base/prefetcher.h"
#include "neural/parser/packed_picture.h"
#include "neural/parser/picture_crops.h"
#include "neural/training/checkpoint.h"
#include "neural/training/training_loop.h"

namespace bodyloom {

class PictureTrainer : public TrainedSystem {
 public:
  void Begin(int first_step) override;
  bool Step(int step) override;

 protected:
  /// `module` learns, `average` becomes its average: two of one kind with the same numbers, on the networks' device.
  /// `training`, `request.side`, `batch`, `seed` and `light_strength` of which are filled in from it, and `train` must
  /// outlive this.
  PictureTrainer(const std::string& name, const PictureTraining& training, const std::vector<PackedPicture>& train,
                 CropRequest request, std::shared_ptr<torch::nn::Module> module,
                 std::shared_ptr<torch::nn::Module> average);

  virtual torch::Tensor LossOf(const CropBatch& batch) = 0;

  TrainingOutcome Train();
  [[nodiscard]] double LearningRate(int step) const;
  /// A line's numbers before a validation's: learning rate, loss.
  [[nodiscard]] std::vector<TrainingFigure> Row(int done) const override;
  [[nodiscard]] double loss() const { return loss_; }

 private:
  const PictureTraining& training_;
  const std::vector<PackedPicture>& train_;
  CropRequest request_;
  std::shared_ptr<torch::nn::Module> module_, average_;
  std::unique_ptr<torch::optim::AdamW> optimizer_;
  Checkpoint checkpoint_;
  double loss_ = 0;                                 ///< of the last step that was reported
  std::unique_ptr<Prefetcher<CropBatch>> batches_;  ///< last: its thread uses the rest
};

}  // namespace bodyloom
