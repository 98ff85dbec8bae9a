// SPDX-License-Identifier: Apache-2.0
/// Options that `bodyloom train refiner|parser` share.
#pragma once

#include "bodyloom/neural/pictures/picture_training.h"

namespace CLI {
class App;
}

namespace bodyloom {

/// --steps, --batch, --crop, --learning-rate, --light-strength, --body-error and those of AddTrainingOptions().
void AddPictureTrainingOptions(CLI::App* verb, PictureTraining* training, double* body_error_px, const char* who_is_off,
                               const char* seed_help);

}  // namespace bodyloom
