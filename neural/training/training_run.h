// SPDX-License-Identifier: Apache-2.0
/// Options that every training run has, how far it is, and how it ended.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace bodyloom {

/// A figure of a run by its name, such as "image", 0.034, or "validation", 21.3, " dB".
struct TrainingFigure {
  const char* name = "";
  double value = 0;
  const char* unit = "";
};

struct TrainingProgress {
  int step = 0, steps = 0;              ///< that the weights have seen, and in all
  std::vector<TrainingFigure> figures;  ///< losses of the last step, then of the last validation, once there was one
  double seconds = 0;

  /// The figure of that name; throws std::invalid_argument when there is none.
  [[nodiscard]] double At(const std::string& name) const;
};

struct TrainingRun {
  int steps = 20000;
  uint64_t seed = 1;
  int num_threads = 0;                                                  ///< of LibTorch; 0: all cores
  std::string device = "cpu";                                           ///< or "cuda" (neural/base/runtime.h)
  int report_every = 20, validate_every = 500, checkpoint_every = 250;  ///< steps
  int patience = 0;         ///< stop after so many validations without a better one (0: never), where there are any
  std::string run_dir;      ///< exists; checkpoint.bin and metrics.csv are written here
  std::string config_json;  ///< kept in the checkpoint as it is
  bool resume = false;      ///< go on from run_dir/checkpoint.bin
  std::function<bool(const TrainingProgress&)> progress;  ///< return false to stop after a checkpoint
};

/// Of what all runs have in common. `why` may be nullptr.
bool IsValidRun(const TrainingRun& run, std::string* why);

enum class TrainingStatus {
  kFinished,
  kStopped,     ///< by the caller, after a checkpoint
  kNoProgress,  ///< patience ran out, after a checkpoint
  kNotFinite    ///< a loss was not finite: the last checkpoint is in place, no step was taken by that loss
};

struct TrainingOutcome {
  TrainingStatus status = TrainingStatus::kNotFinite;
  std::string message;  ///< unless finished: what ended it, and where
  int steps = 0;        ///< that the weights have seen
  double seconds = 0;   ///< of this process
};

/// Of a renderer's training.
struct RendererTraining : TrainingOutcome {
  std::vector<std::string> losses_off;     ///< "shape: the frames have no labels", …
  bool perceptual_random_features = true;  ///< no weights were given for the perceptual loss
  std::string checkpoint;                  ///< the file written, and others beside it
};

/// run_dir/checkpoint.bin.
std::string CheckpointPath(const std::string& run_dir);

}  // namespace bodyloom
