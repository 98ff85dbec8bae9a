// SPDX-License-Identifier: Apache-2.0
/// `bodyloom metrics --lpips`: how pictures differ to networks that look at them.
#pragma once

#include <string>
#include <vector>

#include "bodyloom/pipelines/score/frame_metric.h"

namespace bodyloom {

/// LPIPS v0.1 on AlexNet, and tLPIPS of frames that follow another (FramePair::follows). `weights_folder` may be empty, or lack the weights:
/// then a random-feature substitute measures, and its columns are called so. Throws std::runtime_error naming weights
/// that do not fit.
std::vector<FrameMetric> LikenessMetrics(const std::string& weights_folder);

}  // namespace bodyloom
