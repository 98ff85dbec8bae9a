// SPDX-License-Identifier: Apache-2.0
/// Options of `bodyloom run`, except those of its outputs.
#pragma once

#include "pipelines/track/track_people_in_videos.h"

namespace CLI {
class App;
}

namespace bodyloom {

/// Binds the fields of the request except `out`, `overlay` and `report` to their options; VIDEO is also positional.
void AddRunOptions(CLI::App& app, TrackPeopleClipRequest* request);
/// The same for one or more videos.
void AddRunVideosOptions(CLI::App& app, TrackPeopleInVideosRequest* request);

}  // namespace bodyloom
