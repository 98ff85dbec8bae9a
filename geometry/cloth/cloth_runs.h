// SPDX-License-Identifier: Apache-2.0
/// One garment in one motion, simulated several times.
///
/// Where a fold falls is chance: with a little more friction it falls beside. Who learns from one run takes its folds for
/// the cloth's own; what several runs have in common is what cloth does in that motion.
#pragma once

#include "bodyloom/geometry/cloth/cloth_simulation.h"

namespace bodyloom {

constexpr int kMostClothRuns = 5;

/// The options of one of several runs: those given for run 0; in others friction, damping and air density times e^0.1 or
/// e^-0.1, each run by signs of its own. Throws std::invalid_argument for a run outside 0 to kMostClothRuns − 1.
ClothOptions OfRun(ClothOptions options, int run);

}  // namespace bodyloom
