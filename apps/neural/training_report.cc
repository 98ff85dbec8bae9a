// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/training_report.h"

#include <iostream>
#include <stdexcept>

#include "pipelines/report_text.h"

namespace bodyloom {

void PrintLosses(const RendererTraining& training, const char* perceptual, const char* network) {
  for (const std::string& loss : training.losses_off) std::cout << "loss switched off: " << loss << "\n";
  if (perceptual == nullptr || !training.perceptual_random_features) return;
  std::cout << perceptual << " by a random-feature substitute (no " << network << " weights given)\n";
}

void PrintStep(const TrainingOutcome& outcome, int steps) {
  std::cout << "step " << outcome.steps << " of " << steps << " in " << ClockText(outcome.seconds) << "\n";
}

void PrintEnd(const RendererTraining& training, const std::string& out) {
  std::cout << "wrote " << training.checkpoint << "\n" << std::flush;
  if (training.status == TrainingStatus::kNoProgress) std::cout << training.message << "\n";
  RequireNotStopped(training, out);
}

void RequireNotStopped(const TrainingOutcome& outcome, const std::string& out) {
  if (outcome.status == TrainingStatus::kStopped) {
    throw std::runtime_error(out + ": " + outcome.message + "; go on with --resume");
  }
}

}  // namespace bodyloom
