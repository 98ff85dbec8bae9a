// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/training_session.h"

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "apps/exit_code.h"
#include "apps/interrupt.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/pipelines/clock_text.h"
#include "bodyloom/pipelines/files.h"

namespace bodyloom {

namespace fs = std::filesystem;

void OpenTrainingRun(const std::string& out, TrainingRun* run) {
  if (run->num_threads == 0) run->num_threads = static_cast<int>(std::thread::hardware_concurrency());
  RequireWritableFolder(out);
  run->run_dir = out;
  const bool exists = fs::exists(CheckpointPath(out));
  if (!run->resume && exists) {
    throw RequestError(out + " holds a run already; go on with it by --resume, or choose another --out");
  }
  if (run->resume && !exists) throw RequestError(out + " holds no run to go on with");
}

void WriteRunConfig(const TrainingRun& run) {
  WriteFileAtomically((fs::path(run.run_dir) / "config.json").string(), run.config_json);
}

std::string PreviewPath(const TrainingRun& run, int step) {
  char name[64];
  std::snprintf(name, sizeof name, "preview_%06d.png", step);
  return (fs::path(run.run_dir) / name).string();
}

TrainingBar::TrainingBar(int steps) : steps_(steps), bar_("training " + std::to_string(steps) + " steps") {}

bool TrainingBar::Update(int step, std::initializer_list<std::pair<const char*, double>> losses,
                         const double* psnr_db) {
  std::ostringstream stage;
  stage.precision(3);
  for (const auto& [name, value] : losses) stage << (stage.tellp() > 0 ? ", " : "") << name << ' ' << value;
  if (psnr_db != nullptr) stage << ", validation " << *psnr_db << " dB";
  bar_.Update(stage.str(), static_cast<double>(step) / steps_);
  return !IsInterrupted();
}

void RequireFinite(const TrainingOutcome& outcome, const std::string& out) {
  if (outcome.status == TrainingStatus::kNotFinite) throw std::runtime_error(out + ": " + outcome.message);
}

void SayStandIn(const char* losses, const char* network) {
  std::cout << losses << " by a stand-in of random features (no " << network << " weights given)\n";
}

void SayStep(const TrainingOutcome& outcome, int steps) {
  std::cout << "step " << outcome.steps << " of " << steps << " in " << ClockText(outcome.seconds) << "\n";
}

void EndTrainingRun(const TrainingOutcome& outcome, const std::string& out) {
  std::cout << "wrote " << CheckpointPath(out) << "\n" << std::flush;
  if (outcome.status == TrainingStatus::kNoProgress) std::cout << outcome.message << "\n";
  if (outcome.status == TrainingStatus::kStopped) {
    throw std::runtime_error(out + ": " + outcome.message + "; go on with --resume");
  }
}

}  // namespace bodyloom
