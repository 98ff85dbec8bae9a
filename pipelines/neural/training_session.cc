// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/training_session.h"

#include <cstdio>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/video/image_file.h"
#include "pipelines/files.h"
#include "render/view/contact_sheet.h"

namespace bodyloom {

namespace fs = std::filesystem;

void RequireNoRun(const std::string& out) {
  if (!fs::exists(CheckpointPath(out))) return;
  throw RequestError(out + " holds a run already; go on with it by --resume, or choose another --out");
}

void OpenTrainingRun(const std::string& out, TrainingRun* run) {
  if (run->num_threads == 0) run->num_threads = static_cast<int>(std::thread::hardware_concurrency());
  RequireWritableFolder(out);
  run->run_dir = out;
  if (!run->resume) {
    RequireNoRun(out);
  } else if (!fs::exists(CheckpointPath(out))) {
    throw RequestError(out + " holds no run to go on with");
  }
}

void WriteRunConfig(const TrainingRun& run) {
  WriteFileAtomically((fs::path(run.run_dir) / "config.json").string(), run.config_json);
}

void WritePreview(const TrainingRun& run, int step, const std::vector<std::vector<Image>>& rows, int cell_height_px) {
  if (rows.empty()) return;
  char name[64];
  std::snprintf(name, sizeof name, "preview_%06d.png", step);
  ContactSheetOptions layout;
  layout.columns = static_cast<int>(rows.front().size());
  layout.cell_height_px = cell_height_px;
  std::vector<Image> images;
  for (const std::vector<Image>& row : rows) images.insert(images.end(), row.begin(), row.end());
  WriteImage((fs::path(run.run_dir) / name).string(), ContactSheet(images, layout));
}

void FollowTraining(int steps, const PipelineCallbacks& callbacks, TrainingRun* run) {
  callbacks.Begin("training " + std::to_string(steps) + " steps");
  run->progress = [&callbacks](const TrainingProgress& progress) {
    std::ostringstream stage;
    stage.precision(3);
    for (const auto& [name, value, unit] : progress.figures) {
      stage << (stage.tellp() > 0 ? ", " : "") << name << ' ' << value << unit;
    }
    return callbacks.ReportProgress(stage.str(), static_cast<double>(progress.step) / progress.steps);
  };
}

void RequireFinite(const TrainingOutcome& outcome, const std::string& out) {
  if (outcome.status == TrainingStatus::kNotFinite) throw std::runtime_error(out + ": " + outcome.message);
}

}  // namespace bodyloom
