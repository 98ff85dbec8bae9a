// SPDX-License-Identifier: Apache-2.0
/// The flags of `bodyloom track`.
#pragma once

#include "bodyloom/pipelines/track/track_request.h"

namespace CLI {
class App;
}

namespace bodyloom {

/// Binds every field of the request to its flag; defaults in --help are those of the struct. `quiet` is the verb's own.
void AddTrackOptions(CLI::App& app, TrackRequest* request, bool* quiet);

}  // namespace bodyloom
