// SPDX-License-Identifier: Apache-2.0
/// The bar and the lines that all `bodyloom train …` share.
#pragma once

#include <string>
#include <vector>

#include "neural/training/training_run.h"
#include "pipelines/neural/guided/animate_guided.h"

namespace bodyloom {

/// "loss switched off: shape: the frames have no labels", a line each.
void PrintLossesOff(const std::vector<std::string>& losses_off);

/// "perceptual loss by a random-feature substitute (no VGG-16 weights given)".
void PrintRandomFeatures(const char* losses, const char* network);

/// "step 250 of 400 in 0:31".
void PrintStep(const TrainingOutcome& outcome, int steps);

/// Names what was written and why it ended early; throws as RequireNotStopped.
void PrintEnd(const TrainingOutcome& outcome, const std::string& checkpoint, const std::string& out);

/// Throws std::runtime_error when the user stopped the run in `out`, saying how it goes on.
void RequireNotStopped(const TrainingOutcome& outcome, const std::string& out);

// The lines of `bodyloom animate guided`.

void Print(const AnimateGuidedSummary& summary, const AnimateGuidedRequest& request);

}  // namespace bodyloom
