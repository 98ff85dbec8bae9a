// SPDX-License-Identifier: Apache-2.0
/// Scores of a motion-dependent renderer as one line.
#pragma once

#include <string>

#include "bodyloom/neural/motion/motion_scores.h"

namespace bodyloom {

/// "L1 0.0516, PSNR 20.41 dB, labels IoU 0.847, …": what was not measured (NaN) is left out. Units as in MotionScores.
std::string ScoresText(const MotionScores& scores);

}  // namespace bodyloom
