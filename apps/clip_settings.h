// SPDX-License-Identifier: Apache-2.0
/// Converts clips of a manifest to requests, by the options of `bodyloom track` and `bodyloom run`.
#pragma once

#include <functional>

#include "pipelines/batch/batch_clip.h"
#include "pipelines/batch/manifest.h"

namespace CLI {
class App;
}

namespace bodyloom {

/// Adds the options of `batch` that apply to all clips: those shared by `track` and `run`, and those of either that are
/// often common to many clips. Returns a function that gives, after parsing, the options that were set.
std::function<ClipSettings()> AddClipOptions(CLI::App& verb);

/// Makes the request of a clip from its own settings and, for options that its verb has and it does not set, from those
/// for all clips; without `threads` among them it uses `num_threads`. Throws std::runtime_error naming the manifest's
/// line for an option that the verb does not have, an invalid value, or contradictory options.
BatchClip ClipFrom(const ManifestClip& listed, const ClipSettings& common, int num_threads);

}  // namespace bodyloom
