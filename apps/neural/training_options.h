// SPDX-License-Identifier: Apache-2.0
/// Options shared by `bodyloom train photo|animate|motion`.
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

/// Adds --out.
void AddRunFolderOption(CLI::App* verb, std::string* out);

/// Adds --data of a multi-person dataset, --out, --body.
void AddPeopleOptions(CLI::App* verb, std::string* data, std::string* out, std::string* body);

/// Adds --steps, --batch, --learning-rate. `batch_help`: "Pairs in a batch".
void AddStepOptions(CLI::App* verb, int* steps, int* batch, double* learning_rate, const char* batch_help);

/// Adds --profile.
void AddProfileOption(CLI::App* verb, std::string* profile);

/// Adds --validate-every, --seed, --threads, --device, --resume. `seed_help`: "Of weights and pairs".
void AddTrainingOptions(CLI::App* verb, TrainingRun* run, const char* seed_help);

/// Parses each "12-40" (last frame included) to [12, 41). Throws RequestError naming the option.
std::vector<FrameRange> ParseFrameRanges(const std::vector<std::string>& texts, const char* option);

/// For `bodyloom train motion`: adds --data, --track, --body, --iuv, --mask, --part-labels.
void AddMotionDataOptions(CLI::App* verb, MotionDataRequest* request);

// Output shared by all `bodyloom train …`.

/// Prints "loss switched off: shape: the frames have no labels", one line per loss, and "perceptual loss by a
/// random-feature substitute (no VGG-16 weights given)" if so; `perceptual` nullptr: there is no perceptual loss.
void PrintLosses(const RendererTraining& training, const char* perceptual, const char* network);

/// Prints "step 250 of 400 in 0:31".
void PrintStep(const TrainingOutcome& outcome, int steps);

/// Prints the files written and the reason of an early end; throws as RequireNotStopped.
void PrintEnd(const RendererTraining& training, const std::string& out);

/// Throws std::runtime_error when the user stopped the run in `out`, saying how to resume it.
void RequireNotStopped(const TrainingOutcome& outcome, const std::string& out);

}  // namespace bodyloom
