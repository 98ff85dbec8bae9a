// SPDX-License-Identifier: Apache-2.0
/// Options of every verb that detects people in a video.
#pragma once

#include <optional>
#include <string>

#include "tracking/detection/frame_detector.h"

namespace CLI {
class App;
}

namespace bodyloom {

/// Adds --rotate and --captured-fps, in this group of the help. `turn_deg`: none for auto.
void AddPlaybackOptions(CLI::App& app, std::optional<int>* turn_deg, double* captured_fps, const std::string& group);

/// Adds --detector, --detect-rate (not where `detect_rate` is null), --search-interval, --tiles, --models, --pose-model
/// and --box-model, in this group of the help.
void AddDetectorOptions(CLI::App& app, FrameDetectorOptions* detector, double* detect_rate, const std::string& group);

/// Adds --hands, in this group of the help; without it the choice stays as it is, which the help calls `unless_given`.
void AddHandsOption(CLI::App& app, std::optional<HandsAndFaceChoice>* choice, const std::string& unless_given,
                    const std::string& group);

}  // namespace bodyloom
