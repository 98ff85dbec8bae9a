// SPDX-License-Identifier: Apache-2.0
/// Clips of a manifest as requests, by the options of `bodyloom track` and `bodyloom run`.
#pragma once

#include <functional>

#include "pipelines/batch/batch_clip.h"
#include "pipelines/batch/manifest.h"

namespace CLI {
class App;
}

namespace bodyloom {

/// Adds the options of `batch` that hold for all clips: those that `track` and `run` share, and of each the ones that
/// many clips have in common. Returns what gives, after parsing, those that were given.
std::function<ClipSettings()> AddClipOptions(CLI::App& verb);

/// The request of a clip: its own settings, and of those for all clips the ones that its verb has and it does not give
/// itself; without `threads` among them it takes `num_threads`. Throws std::runtime_error naming the manifest's line
/// when its verb has no such option, a value is none of the option's, or options contradict each other.
BatchClip ClipFrom(const ManifestClip& listed, const ClipSettings& common, int num_threads);

}  // namespace bodyloom
