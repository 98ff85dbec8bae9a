// SPDX-License-Identifier: Apache-2.0
/// Options of every verb that detects people in a video.
#pragma once

#include <string>

#include "tracking/detection/frame_detector.h"

namespace CLI {
class App;
}

namespace bodyloom {

/// Adds --detector, --detect-rate, --models, --pose-model and --box-model, in this group of the help.
void AddDetectorOptions(CLI::App& app, FrameDetectorOptions* detector, double* detect_rate, const std::string& group);

}  // namespace bodyloom
