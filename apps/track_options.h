// SPDX-License-Identifier: Apache-2.0
/// Options of `bodyloom track`, in groups that are shared with other verbs that track.
#pragma once

#include <string>

#include "pipelines/track/track_people_in_videos.h"
#include "pipelines/track/track_request.h"
#include "pipelines/track/view_inputs.h"

namespace CLI {
class App;
}

namespace CLI {
class App;
}

namespace bodyloom {

/// Adds those of AddDetectorOptions() and AddPlaybackOptions(), --hands, --no-mask, --from and --to, in this group of
/// the help. `hands`: the default that the help names.
void AddDetectionOptions(CLI::App& app, TrackSettings* request, const std::string& hands, const std::string& group);
/// Adds --cameras, --focal and --focal-35mm.
void AddCalibrationOptions(CLI::App& app, TrackSettings* request);
/// Adds --camera-path with its companions, --still and --camera-path-out.
void AddCameraPathOptions(CLI::App& app, TrackSettings* request);
/// Adds --body, --stature, --prior and --lifter.
void AddLearnedOptions(CLI::App& app, TrackSettings* request);
/// Adds --solver, --threads, --max-iterations, --straight-knees and the switches that disable parts of the tracker.
void AddSolveOptions(CLI::App& app, TrackSettings* request);

/// Binds every field of the request to its option; defaults in --help are those of the struct. `quiet` is the verb's
/// own.
void AddTrackOptions(CLI::App& app, TrackRequest* request, bool* quiet);
/// Adds --known and --same-lens, what is known of several cameras, in this group of the help.
void AddKnownOfRigOptions(CLI::App& app, KnownOfRig* known, bool* same_lens, const std::string& group);
/// Those of AddTrackOptions() with several views.
void AddTrackViewsOptions(CLI::App& app, TrackViewsRequest* request, bool* quiet);

// Options of `bodyloom run`, except those of its outputs.

/// Binds the fields of the request except `out`, `overlay` and `report` to their options; VIDEO is also positional.
void AddRunOptions(CLI::App& app, TrackPeopleClipRequest* request);
/// The same for one or more videos.
void AddRunVideosOptions(CLI::App& app, TrackPeopleInVideosRequest* request);

}  // namespace bodyloom
