// SPDX-License-Identifier: Apache-2.0
/// Options that `bodyloom train photo|animate|motion` share.
#pragma once

#include <string>

#include "bodyloom/neural/training/training_run.h"

namespace CLI {
class App;
}

namespace bodyloom {

/// --profile.
void AddProfileOption(CLI::App* verb, std::string* profile);

/// --validate-every, --seed, --threads, --device, --resume. `seed_help`: "Of weights and pairs".
void AddTrainingOptions(CLI::App* verb, TrainingRun* run, const char* seed_help);

}  // namespace bodyloom
