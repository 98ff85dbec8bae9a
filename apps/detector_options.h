// SPDX-License-Identifier: Apache-2.0
/// Options of every verb that detects people in a video.
#pragma once

#include <string>

#include "bodyloom/data_tools/detection/pose_detector.h"

namespace CLI {
class App;
}

namespace bodyloom {

/// --detector, --detect-rate and --models, in this group of the help.
void AddDetectorOptions(CLI::App& app, PoseNetworkSize* network, double* detect_rate, std::string* models,
                        const std::string& group);

}  // namespace bodyloom
