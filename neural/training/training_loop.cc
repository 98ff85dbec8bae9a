// SPDX-License-Identifier: Apache-2.0
#include "neural/training/training_loop.h"

#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>

#include "geometry/base/check.h"
#include "geometry/base/stopwatch.h"
#include "neural/training/run_files.h"

namespace bodyloom {

namespace fs = std::filesystem;

std::string CheckpointPath(const std::string& run_dir) { return (fs::path(run_dir) / "checkpoint.bin").string(); }

bool IsValidRun(const TrainingRun& run, std::string* why) {
  const InRange in_range(why);
  if (run.device != "cpu" && run.device != "cuda") {
    if (why != nullptr) *why = Concatenate("device is \"", run.device, "\", expected cpu or cuda");
    return false;
  }
  return in_range("steps", run.steps, 1, 1e8) && in_range("num_threads", run.num_threads, 0, 256) &&
         in_range("report_every", run.report_every, 1, 1e8) && in_range("validate_every", run.validate_every, 1, 1e8) &&
         in_range("checkpoint_every", run.checkpoint_every, 1, 1e8) && in_range("patience", run.patience, 0, 1e6);
}

double TrainingProgress::At(const std::string& name) const {
  for (const TrainingFigure& figure : figures) {
    if (name == figure.name) return figure.value;
  }
  throw std::invalid_argument("training: no figure \"" + name + "\"");
}

TrainingOutcome RunTraining(const TrainingRun& run, int total_steps, Checkpoint* checkpoint, TrainedSystem* system) {
  std::vector<std::string> columns;
  for (const TrainingFigure& figure : system->Row(1)) columns.emplace_back(figure.name);
  for (const TrainingFigure& figure : system->ScoreRow()) columns.emplace_back(figure.name);
  columns.emplace_back("seconds");
  MetricsLog log((fs::path(run.run_dir) / "metrics.csv").string(), columns);
  const std::string path = CheckpointPath(run.run_dir);
  int done = 0, last_saved = 0;
  if (run.resume) {
    checkpoint->Load(path);
    done = last_saved = static_cast<int>(checkpoint->step);
    log.KeepUpTo(done);
  }
  const Stopwatch watch;
  const auto save = [&] {
    checkpoint->step = last_saved = done;
    checkpoint->Save(path);
  };
  system->Begin(done);
  TrainingOutcome outcome;
  outcome.status = TrainingStatus::kFinished;
  while (done < total_steps && outcome.status == TrainingStatus::kFinished) {
    if (!system->Step(done)) {
      outcome.status = TrainingStatus::kNotFinite;
      outcome.message =
          Concatenate("the loss is not finite at step ", done + 1, "; checkpoint.bin holds step ", last_saved);
      break;
    }
    ++done;
    const bool last = done == total_steps;
    const bool validates = system->HasValidation() && (last || done % run.validate_every == 0);
    if (validates) system->Validate(done, last);
    if (last || validates || done % run.report_every == 0) {
      std::vector<double> row;
      for (const TrainingFigure& figure : system->Row(done)) row.push_back(figure.value);
      for (const TrainingFigure& score : system->ScoreRow()) {
        row.push_back(validates ? score.value : std::numeric_limits<double>::quiet_NaN());
      }
      row.push_back(watch.seconds());
      log.Add(done, row);
      if (run.progress && !run.progress({done, total_steps, system->Figures(), watch.seconds()})) {
        outcome.status = TrainingStatus::kStopped;
        outcome.message = Concatenate("stopped at step ", done);
      } else if (run.patience > 0 && system->ValidationsSinceBest() >= run.patience) {
        outcome.status = TrainingStatus::kNoProgress;
        outcome.message = Concatenate("no better validation in the last ", run.patience, "; stopped at step ", done);
      }
    }
    if (last || done % run.checkpoint_every == 0 || outcome.status != TrainingStatus::kFinished) save();
  }
  outcome.steps = done;
  outcome.seconds = watch.seconds();
  return outcome;
}

}  // namespace bodyloom
