// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/training_report.h"

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <stdexcept>

#include "apps/neural/animate_options.h"
#include "apps/neural/score_options.h"
#include "pipelines/report_text.h"

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

void Print(const AnimateGuidedSummary& summary, const AnimateGuidedRequest& request) {
  std::printf(
      "%d frames, source encoded in %.1f s, networks %.0f ms a frame (%.0f %% of the window), %.1f frames/s in all\n",
      summary.frames, summary.source_seconds, summary.network_ms, 100 * summary.computed_share,
      summary.frames / std::max(1e-9, summary.frame_seconds));
  PrintFramesWithoutFit(summary);
  if (summary.frames_kept > 0) {
    std::printf("%lld frames were those before and were not computed again\n",
                static_cast<long long>(summary.frames_kept));
  }
  if (summary.scores) std::printf("against %s: %s\n", request.data.c_str(), ScoresText(*summary.scores).c_str());
  std::printf("wrote %s\n", request.out.c_str());
}

}  // namespace bodyloom
