// SPDX-License-Identifier: Apache-2.0
/// Scores of a motion-dependent renderer as one line.
#pragma once

#include <string>

#include "bodyloom/neural/motion/motion_scores.h"

namespace bodyloom {

/// "L1 0.0516, PSNR 20.41 dB, SSIM 0.9312, LPIPS 0.0387, labels IoU 0.847, …": what was not measured (NaN) is left out,
/// LPIPS of random features is called so. Units as in MotionScores.
std::string ScoresText(const MotionScores& scores);
/// The same of single frames' scores or their means.
std::string ScoresText(const MotionFrameScores& scores, bool lpips_random_features);

}  // namespace bodyloom
