// SPDX-License-Identifier: Apache-2.0
/// A training session, around the training of any network: the run's folder, its progress, its end.
#pragma once

#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "neural/training/training_run.h"
#include "render/image/image.h"

namespace bodyloom {

/// run_dir is `out` from now on, num_threads all cores where it was 0. Throws RequestError when there is a run to go on
/// with and `run->resume` is not set, or the other way about; std::runtime_error when the folder cannot be written.
void OpenTrainingRun(const std::string& out, TrainingRun* run);

/// Throws RequestError when `out` holds a run already.
void RequireNoRun(const std::string& out);

/// config.json, from config_json.
void WriteRunConfig(const TrainingRun& run);

/// RUN/preview_000250.png: rows of as many pictures each, all scaled to one height; nothing without a row.
void WritePreview(const TrainingRun& run, int step, const std::vector<std::vector<Image>>& rows, int cell_height_px);

/// Tells the caller of a job how its training goes, as a work of its own ("training 400 steps") that begins now. The
/// stage is "loss 0.12, image 0.034, validation 21.3 dB" (TrainingProgress::figures). Unlike other jobs' a cancelled
/// training ends with a checkpoint and a summary (TrainingStatus::kStopped), not with Cancelled. `callbacks` must
/// outlive the training.
void FollowTraining(int steps, const PipelineCallbacks& callbacks, TrainingRun* run);

/// Throws std::runtime_error when training broke off at a loss that is no number.
void RequireFinite(const TrainingOutcome& outcome, const std::string& out);

}  // namespace bodyloom
