// SPDX-License-Identifier: Apache-2.0
/// Options that every training of a picture U-Net (render/person/picture_unet.h) has.
#pragma once

#include <string>

#include "bodyloom/neural/training/training_run.h"

namespace bodyloom {

struct PictureTraining : TrainingRun {
  PictureTraining() { steps = 8000; }
  int crop = 192;  ///< pixels a side, a multiple of kPictureUnetMultiple
  int batch = 8;
  double learning_rate = 1e-3;
  int warmup_steps = 100;
  double weight_decay = 1e-4;
  double average_share = 0.1;  ///< of the steps: the mean age of the averaged weights
  double light_strength = 1;   ///< of the change of colours that each crop gets: 0 none
};

/// Of what all have in common. `why` may be nullptr.
bool IsValidPictureTraining(const PictureTraining& training, std::string* why);

}  // namespace bodyloom
