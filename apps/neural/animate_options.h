// SPDX-License-Identifier: Apache-2.0
/// Options and output shared by `bodyloom animate photo|animate|motion`.
#pragma once

#include <string>

#include "pipelines/neural/animation.h"
#include "pipelines/neural/motion/animate_motion.h"

namespace CLI {
class App;
}

namespace bodyloom {

/// Help text of --full-size.
inline constexpr const char* kFullSizeHelp =
    "Images as large as the track's, the person enlarged to them (default: as large as the networks draw)";

/// Adds --weights of the verbs that print LPIPS or contextual scores; `what`: names and purposes of the files.
void AddLikenessWeights(CLI::App* verb, std::string* weights, const char* what);

/// Adds --threads, --device.
void AddDeviceOptions(CLI::App* verb, AnimationRequest* request);

/// Prints a line if frames have no fit.
void PrintFramesWithoutFit(const AnimationSummary& summary);

/// Command lines that repeat a job, stored in output files.
/// "bodyloom animate motion --run run …": the options that affect the result, without those left at their defaults.
std::string CommandLine(const AnimateMotionRequest& request);

}  // namespace bodyloom
