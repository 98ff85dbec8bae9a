// SPDX-License-Identifier: Apache-2.0
/// Options of `bodyloom synth`.
#pragma once

#include "pipelines/synthesis/synthesize_clip.h"

namespace CLI {
class App;
}

namespace bodyloom {

/// Help text of the option that names a motion (MotionSource).
constexpr const char* kMotionHelp =
    "AMASS .npz, AIST++ .pkl, BVH, Acclaim .amc, DeepMimic JSON or AMP .npy; or the word demo";

/// Binds every field of the request to its option; defaults in --help are those of the struct. `quiet` is the verb's
/// own.
void AddSynthOptions(CLI::App& app, SynthesizeClipRequest* request, bool* quiet);

}  // namespace bodyloom
