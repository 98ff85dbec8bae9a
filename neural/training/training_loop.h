// SPDX-License-Identifier: Apache-2.0
/// The loop of a training run: steps, log, validation, checkpoints, early stopping. Internal: includes LibTorch.
#pragma once

#include <vector>

#include "neural/training/checkpoint.h"
#include "neural/training/training_run.h"

namespace bodyloom {

/// Interface of networks trained step by step. Steps are counted from 0; `done` is the number of completed steps.
class TrainedSystem {
 public:
  virtual ~TrainedSystem() = default;

  /// Called once, before the first step; batches of earlier steps will not be requested.
  virtual void Begin(int first_step) = 0;
  /// Performs a step. False when a loss is not finite; the weights are then unchanged.
  virtual bool Step(int step) = 0;
  [[nodiscard]] virtual bool HasValidation() const = 0;
  virtual void Validate(int done, bool last) = 0;
  /// Number of validations since the best one.
  [[nodiscard]] virtual int ValidationsSinceBest() const { return 0; }
  /// A line of metrics.csv between step and seconds: first these figures, then the scores of a validation, whose cells
  /// are empty without one. NaN: an empty cell. The names are the columns and must not change.
  [[nodiscard]] virtual std::vector<TrainingFigure> Row(int done) const = 0;
  [[nodiscard]] virtual std::vector<TrainingFigure> ScoreRow() const = 0;
  /// Figures reported to the caller (TrainingProgress::figures).
  [[nodiscard]] virtual std::vector<TrainingFigure> Figures() const = 0;
};

/// Runs `total_steps` steps (run.steps are those of one stage). metrics.csv has the columns step, those of the rows,
/// seconds. A run resumed from a checkpoint ends with the same bytes as an uninterrupted one, provided that the
/// system's steps depend only on their number and the checkpoint's contents. Throws std::runtime_error for files that
/// cannot be used.
TrainingOutcome RunTraining(const TrainingRun& run, int total_steps, Checkpoint* checkpoint, TrainedSystem* system);

}  // namespace bodyloom
