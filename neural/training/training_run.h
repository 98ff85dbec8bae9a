// SPDX-License-Identifier: Apache-2.0
/// Common options, progress and outcome of training runs.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace bodyloom {

/// A named figure of a run, such as "image", 0.034, or "validation", 21.3, " dB".
struct TrainingFigure {
  const char* name = "";
  double value = 0;
  const char* unit = "";
};

struct TrainingProgress {
  int step = 0, steps = 0;              ///< completed and total
  std::vector<TrainingFigure> figures;  ///< losses of the last step, then scores of the last validation, if any
  double seconds = 0;

  /// The figure of a name; throws std::invalid_argument when there is none.
  [[nodiscard]] double At(const std::string& name) const;
};

struct TrainingRun {
  int steps = 20000;
  uint64_t seed = 1;
  int num_threads = 0;                                                  ///< of LibTorch; 0: all cores
  std::string device = "cpu";                                           ///< or "cuda" (neural/base/runtime.h)
  int report_every = 20, validate_every = 500, checkpoint_every = 250;  ///< steps
  int patience = 0;         ///< stop after so many validations without improvement (0: never)
  std::string run_dir;      ///< exists; checkpoint.bin and metrics.csv are written here
  std::string config_json;  ///< stored in the checkpoint unchanged
  bool resume = false;      ///< resume from run_dir/checkpoint.bin
  std::function<bool(const TrainingProgress&)> progress;  ///< return false to stop after a checkpoint
};

/// Checks the common options. `why` may be nullptr.
bool IsValidRun(const TrainingRun& run, std::string* why);

enum class TrainingStatus {
  kFinished,
  kStopped,     ///< by the caller, after a checkpoint
  kNoProgress,  ///< no improvement within patience, after a checkpoint
  kNotFinite    ///< a loss was not finite: no step was taken by it, the last checkpoint is kept
};

struct TrainingOutcome {
  TrainingStatus status = TrainingStatus::kNotFinite;
  std::string message;  ///< unless finished: reason and step
  int steps = 0;        ///< completed
  double seconds = 0;   ///< in this process
};

/// Outcome of a renderer's training.
struct RendererTraining : TrainingOutcome {
  std::vector<std::string> losses_off;     ///< "shape: the frames have no labels", …
  bool perceptual_random_features = true;  ///< no weights were provided for the perceptual loss
  std::string checkpoint;                  ///< path of the file; other files are in its folder
};

/// run_dir/checkpoint.bin.
std::string CheckpointPath(const std::string& run_dir);

}  // namespace bodyloom
