// SPDX-License-Identifier: Apache-2.0
/// Options and lines that `bodyloom animate photo|animate|motion` share.
#pragma once

#include <string>

#include "pipelines/neural/animation.h"

namespace CLI {
class App;
}

namespace bodyloom {

/// Of --full-size.
inline constexpr const char* kFullSizeHelp =
    "Pictures as large as the track's, the person enlarged to them (default: as large as the networks draw)";

/// --weights of the verbs that print LPIPS or contextual scores; `what`: the files' names and what they are for.
void AddLikenessWeights(CLI::App* verb, std::string* weights, const char* what);

/// --threads, --device.
void AddDeviceOptions(CLI::App* verb, AnimationRequest* request);

/// A line where frames have no fit.
void PrintFramesWithoutFit(const AnimationSummary& summary);

}  // namespace bodyloom
