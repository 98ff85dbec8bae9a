// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/picture_training_options.h"

#include <CLI/CLI.hpp>
#include <string>

#include "apps/neural/training_options.h"

namespace bodyloom {

void AddPictureTrainingOptions(CLI::App* verb, PictureTraining* training, double* body_error_px, const char* who_is_off,
                               const char* seed_help) {
  verb->add_option("--steps", training->steps, "Batches to train on")->capture_default_str();
  verb->add_option("--batch", training->batch, "Crops in a batch")->capture_default_str();
  verb->add_option("--crop", training->crop, "Pixels of a crop's side, a multiple of 16")->capture_default_str();
  verb->add_option("--learning-rate", training->learning_rate, "At its highest")->capture_default_str();
  verb->add_option("--light-strength", training->light_strength,
                   "Of the change of colours, drawn and true alike, that each crop gets; 0: none")
      ->capture_default_str();
  verb->add_option("--body-error", *body_error_px,
                   std::string(who_is_off) +
                       " are off by up to this, as fitted ones are: mean distance of projected vertices, pixels in a "
                       "picture whose longer side has 512")
      ->check(CLI::Range(0.0, 50.0))
      ->capture_default_str();
  AddTrainingOptions(verb, training, seed_help);
}

}  // namespace bodyloom
