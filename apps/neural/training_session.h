// SPDX-License-Identifier: Apache-2.0
/// What every `bodyloom train …` does around its training: the run's folder, the progress line, the words at the end.
#pragma once

#include <initializer_list>
#include <string>
#include <utility>

#include "apps/progress.h"
#include "bodyloom/neural/training/training_run.h"

namespace bodyloom {

/// run_dir is `out` from now on, num_threads all cores where it was 0. Throws RequestError when there is a run to go on
/// with and --resume was not given, or the other way about; std::runtime_error when the folder cannot be written.
void OpenTrainingRun(const std::string& out, TrainingRun* run);

/// config.json, from config_json.
void WriteRunConfig(const TrainingRun& run);

/// RUN/preview_000250.png.
std::string PreviewPath(const TrainingRun& run, int step);

/// The progress line of a training run.
class TrainingBar {
 public:
  explicit TrainingBar(int steps);
  /// "loss 0.12, image 0.034, validation 21.3 dB"; `psnr_db` nullptr: no validation yet. False once the user wants it
  /// to stop.
  bool Update(int step, std::initializer_list<std::pair<const char*, double>> losses, const double* psnr_db);

 private:
  int steps_;
  Progress bar_;
};

/// Throws std::runtime_error when training broke off at a loss that is no number.
void RequireFinite(const TrainingOutcome& outcome, const std::string& out);

/// "perceptual loss by a stand-in of random features (no VGG-16 weights given)".
void SayStandIn(const char* losses, const char* network);

/// "step 250 of 400 in 0:31".
void SayStep(const TrainingOutcome& outcome, int steps);

/// Names what was written and why it ended early; throws std::runtime_error when the user stopped it.
void EndTrainingRun(const TrainingOutcome& outcome, const std::string& out);

}  // namespace bodyloom
