// SPDX-License-Identifier: Apache-2.0
/// The flags of `bodyloom run` but those of its outputs.
#pragma once

#include "pipelines/track/track_people_clip.h"

namespace CLI {
class App;
}

namespace bodyloom {

/// Binds the fields of the request but `out`, `overlay` and `report` to their flags; VIDEO is a positional too.
void AddRunOptions(CLI::App& app, TrackPeopleClipRequest* request);

}  // namespace bodyloom
