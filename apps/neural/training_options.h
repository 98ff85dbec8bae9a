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
