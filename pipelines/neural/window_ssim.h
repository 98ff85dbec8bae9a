// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bodyloom/data_tools/evaluation/ssim.h"

namespace bodyloom {

/// SSIM of the windows that renderers draw, whole, on black: what training and animation report.
inline constexpr SsimPreset kWindowSsim = SsimPreset::kWang2004;
inline double WindowSsim(const Image& truth, const Image& result) { return Ssim(truth, result, kWindowSsim); }

}  // namespace bodyloom
