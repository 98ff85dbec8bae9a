// SPDX-License-Identifier: Apache-2.0
/// Trains the picture refiner (render/person/refiner_weights.h) on drawn people and the truth.
///
///   loss = mean |P − T| + λ_A mean |alpha' − alpha_T| + λ_V Σ mean |vgg(P) − vgg(T)|
/// P and T: the refined and the true person over the same background, one random colour an example, so that alpha is
/// learned and not only its product with colour; vgg: VGG-16's relu 1-2, 2-2 and 3-3, or a random-feature substitute.
/// A refiner that leaves the outline alone learns colours under the drawn alpha: T is the true colour where the person
/// truly is, elsewhere the drawn one, which is to stay. Half of the crops lie around a pixel that the drawing has wrongly
/// inside or outside the person (hems, hair, hands); the others anywhere. Drawn and true colours of a crop are in one
/// random light (neural/pictures/picture_crops.h), so that no colour is learned by heart. Steps as
/// neural/pictures/picture_trainer.h has them.
///
/// Writes into run_dir: checkpoint.bin and metrics.csv. A run that goes on from a checkpoint ends with the same bytes
/// as one that was never interrupted (same binary, machine and threads).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bodyloom/neural/networks/named_weights.h"
#include "bodyloom/neural/pictures/packed_picture.h"
#include "bodyloom/neural/pictures/picture_training.h"
#include "bodyloom/neural/training/training_run.h"
#include "bodyloom/render/person/refiner_weights.h"

namespace bodyloom {

struct TrainRefinerProgress {
  int step = 0, steps = 0;
  double loss = 0, image = 0;                     ///< of the last step
  double drawn_psnr_db = 0, refined_psnr_db = 0;  ///< of the last validation, 0 before the first
  double seconds = 0;
};

struct TrainRefinerOptions : PictureTraining {
  bool moves_outline = false;  ///< RefinerWeights
  double alpha_weight = 1;     ///< where the outline moves
  double perceptual_weight = 0.1;
  WeightsFrom vgg16;                                          ///< empty: a seeded random-feature substitute
  std::function<bool(const TrainRefinerProgress&)> progress;  ///< return false to stop after a checkpoint
  [[nodiscard]] bool IsValid(std::string* why) const;
};

struct TrainRefinerSummary : TrainingOutcome {
  /// Over the true person or the drawn one, all validation pictures together, black behind them; 0 without any.
  double drawn_psnr_db = 0, refined_psnr_db = 0;
};

struct TrainRefinerResult {
  TrainRefinerSummary summary;
  RefinerWeights weights;  ///< without a recipe and people's size
};

/// Throws std::invalid_argument for options that are not valid, no picture to train on, or one whose sizes do not fit,
/// std::runtime_error for files that cannot be used.
TrainRefinerResult TrainRefiner(const std::vector<PackedPicture>& train, const std::vector<PackedPicture>& validation,
                                const TrainRefinerOptions& options);

}  // namespace bodyloom
