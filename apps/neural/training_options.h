// SPDX-License-Identifier: Apache-2.0
/// Options that `bodyloom train photo|animate|motion` share.
#pragma once

#include <string>
#include <vector>

#include "neural/motion/rollout_plan.h"
#include "neural/training/training_run.h"
#include "pipelines/neural/motion/motion_data.h"

namespace CLI {
class App;
}

namespace bodyloom {

/// --out.
void AddRunFolderOption(CLI::App* verb, std::string* out);

/// --data of a multi-person dataset, --out, --body.
void AddPeopleOptions(CLI::App* verb, std::string* data, std::string* out, std::string* body);

/// --steps, --batch, --learning-rate. `batch_help`: "Pairs in a batch".
void AddStepOptions(CLI::App* verb, int* steps, int* batch, double* learning_rate, const char* batch_help);

/// --profile.
void AddProfileOption(CLI::App* verb, std::string* profile);

/// --validate-every, --seed, --threads, --device, --resume. `seed_help`: "Of weights and pairs".
void AddTrainingOptions(CLI::App* verb, TrainingRun* run, const char* seed_help);

/// "12-40" (last frame included) → [12, 41), each. Throws RequestError naming the option.
std::vector<FrameRange> ParseFrameRanges(const std::vector<std::string>& texts, const char* option);

}  // namespace bodyloom

// Options of `bodyloom train motion` that say what is trained on.

namespace CLI {
class App;
}

namespace bodyloom {

/// --data, --track, --body, --iuv, --mask, --part-labels.
void AddMotionDataOptions(CLI::App* verb, MotionDataRequest* request);

}  // namespace bodyloom
