// SPDX-License-Identifier: Apache-2.0
/// The bar and the lines that all `bodyloom train …` share.
#pragma once

#include <string>

#include "neural/training/training_run.h"

namespace bodyloom {

/// "loss switched off: shape: the frames have no labels", a line each, and "perceptual loss by a random-feature
/// substitute (no VGG-16 weights given)" where it is; `perceptual` nullptr: there is no such loss.
void PrintLosses(const RendererTraining& training, const char* perceptual, const char* network);

/// "step 250 of 400 in 0:31".
void PrintStep(const TrainingOutcome& outcome, int steps);

/// Names what was written and why it ended early; throws as RequireNotStopped.
void PrintEnd(const RendererTraining& training, const std::string& out);

/// Throws std::runtime_error when the user stopped the run in `out`, saying how it goes on.
void RequireNotStopped(const TrainingOutcome& outcome, const std::string& out);

}  // namespace bodyloom
