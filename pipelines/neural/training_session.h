// SPDX-License-Identifier: Apache-2.0
/// Shared parts of all training sessions: the run's folder, progress and the end of the training.
#pragma once

#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "neural/training/training_run.h"
#include "render/image/image.h"

namespace bodyloom {

/// Sets run_dir to `out` and num_threads to all cores if it was 0. Throws RequestError if a run exists and
/// `run->resume` is not set, or the reverse; std::runtime_error when the folder cannot be written.
void OpenTrainingRun(const std::string& out, TrainingRun* run);

/// Throws RequestError if `out` already holds a run.
void RequireNoRun(const std::string& out);

/// Writes config.json from config_json.
void WriteRunConfig(const TrainingRun& run);

/// Writes RUN/preview_000250.png: rows of equally many images, all scaled to one height; nothing without rows.
void WritePreview(const TrainingRun& run, int step, const std::vector<std::vector<Image>>& rows, int cell_height_px);

/// Reports the progress of a training to the job's caller, as a job of its own ("training 400 steps") that starts now.
/// The stage is "loss 0.12, image 0.034, validation 21.3 dB" (TrainingProgress::figures). Unlike other jobs, a
/// cancelled training ends with a checkpoint and a summary (TrainingStatus::kStopped) instead of Cancelled. `callbacks`
/// must outlive the training.
void FollowTraining(int steps, const PipelineCallbacks& callbacks, TrainingRun* run);

/// Throws std::runtime_error when training stopped at a loss that is not finite.
void RequireFinite(const TrainingOutcome& outcome, const std::string& out);

}  // namespace bodyloom
