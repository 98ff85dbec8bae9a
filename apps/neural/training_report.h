// SPDX-License-Identifier: Apache-2.0
/// Output shared by all `bodyloom train …`.
#pragma once

#include <string>

#include "neural/training/training_run.h"

namespace bodyloom {

/// Prints "loss switched off: shape: the frames have no labels", one line per loss, and "perceptual loss by a
/// random-feature substitute (no VGG-16 weights given)" if so; `perceptual` nullptr: there is no perceptual loss.
void PrintLosses(const RendererTraining& training, const char* perceptual, const char* network);

/// Prints "step 250 of 400 in 0:31".
void PrintStep(const TrainingOutcome& outcome, int steps);

/// Prints the files written and the reason of an early end; throws as RequireNotStopped.
void PrintEnd(const RendererTraining& training, const std::string& out);

/// Throws std::runtime_error when the user stopped the run in `out`, saying how to resume it.
void RequireNotStopped(const TrainingOutcome& outcome, const std::string& out);

}  // namespace bodyloom
