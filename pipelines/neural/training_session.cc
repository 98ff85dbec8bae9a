// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/training_session.h"

#include <cstdio>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "data_tools/formats/atomic_file.h"
#include "pipelines/files.h"

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

std::string PreviewPath(const TrainingRun& run, int step) {
  char name[64];
  std::snprintf(name, sizeof name, "preview_%06d.png", step);
  return (fs::path(run.run_dir) / name).string();
}

TrainingProgress::TrainingProgress(int steps, const PipelineCallbacks& callbacks)
    : steps_(steps), callbacks_(callbacks) {
  callbacks.Begin("training " + std::to_string(steps) + " steps");
}

bool TrainingProgress::Update(int step, std::initializer_list<std::pair<const char*, double>> losses,
                              const double* psnr_db) const {
  if (!callbacks_.progress) return true;
  std::ostringstream stage;
  stage.precision(3);
  for (const auto& [name, value] : losses) stage << (stage.tellp() > 0 ? ", " : "") << name << ' ' << value;
  if (psnr_db != nullptr) stage << ", validation " << *psnr_db << " dB";
  return callbacks_.progress(stage.str(), static_cast<double>(step) / steps_);
}

void RequireFinite(const TrainingOutcome& outcome, const std::string& out) {
  if (outcome.status == TrainingStatus::kNotFinite) throw std::runtime_error(out + ": " + outcome.message);
}

}  // namespace bodyloom
