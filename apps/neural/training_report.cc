// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/training_report.h"

#include <iostream>
#include <stdexcept>

#include "bodyloom/pipelines/clock_text.h"

namespace bodyloom {

void PrintLossesOff(const std::vector<std::string>& losses_off) {
  for (const std::string& loss : losses_off) std::cout << "loss switched off: " << loss << "\n";
}

void PrintRandomFeatures(const char* losses, const char* network) {
  std::cout << losses << " by a random-feature substitute (no " << network << " weights given)\n";
}

void PrintStep(const TrainingOutcome& outcome, int steps) {
  std::cout << "step " << outcome.steps << " of " << steps << " in " << ClockText(outcome.seconds) << "\n";
}

void PrintEnd(const TrainingOutcome& outcome, const std::string& checkpoint, const std::string& out) {
  std::cout << "wrote " << checkpoint << "\n" << std::flush;
  if (outcome.status == TrainingStatus::kNoProgress) std::cout << outcome.message << "\n";
  RequireNotStopped(outcome, out);
}

void RequireNotStopped(const TrainingOutcome& outcome, const std::string& out) {
  if (outcome.status == TrainingStatus::kStopped) {
    throw std::runtime_error(out + ": " + outcome.message + "; go on with --resume");
  }
}

}  // namespace bodyloom
