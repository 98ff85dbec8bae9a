// SPDX-License-Identifier: Apache-2.0
/// The loop around the steps of a training run: log, validation, checkpoints, early stop. Internal: includes LibTorch.
#pragma once

#include <vector>

#include "neural/training/checkpoint.h"
#include "neural/training/training_run.h"

namespace bodyloom {

/// Networks that learn step by step. Steps are counted from 0; `done` are those that the weights have seen.
class TrainedSystem {
 public:
  virtual ~TrainedSystem() = default;

  /// Called once, before the first step; batches of earlier steps will not be requested.
  virtual void Begin(int first_step) = 0;
  /// False when a loss is not finite; the weights are then those of before.
  virtual bool Step(int step) = 0;
  [[nodiscard]] virtual bool HasValidation() const = 0;
  virtual void Validate(int done, bool last) = 0;
  /// How many validations came since the best one.
  [[nodiscard]] virtual int ValidationsSinceBest() const { return 0; }
  /// A line of metrics.csv between the step and the seconds: first these, then the scores of a validation, whose cells
  /// stay empty where there was none. NaN: an empty cell. The names are the columns, the same from the beginning on.
  [[nodiscard]] virtual std::vector<TrainingFigure> Row(int done) const = 0;
  [[nodiscard]] virtual std::vector<TrainingFigure> ScoreRow() const = 0;
  /// What the caller is told (TrainingProgress::figures).
  [[nodiscard]] virtual std::vector<TrainingFigure> Figures() const = 0;
};

/// Runs `total_steps` steps (run.steps are those of one stage). metrics.csv has the columns step, the rows', seconds. A
/// run that goes on from a checkpoint ends with the same bytes as one that was never interrupted, provided the system's
/// steps depend on nothing but their number and what the checkpoint holds. Throws std::runtime_error for files that
/// cannot be used.
TrainingOutcome RunTraining(const TrainingRun& run, int total_steps, Checkpoint* checkpoint, TrainedSystem* system);

}  // namespace bodyloom
