// SPDX-License-Identifier: Apache-2.0
/// The flags of `bodyloom track`, and those groups of them that other verbs that track have too.
#pragma once

#include <string>

#include "pipelines/track/track_request.h"

namespace CLI {
class App;
}

namespace bodyloom {

/// Those of AddDetectorOptions(), --no-mask, --from and --to, in this group of the help.
void AddDetectionOptions(CLI::App& app, TrackSettings* request, const std::string& group);
/// --cameras and --focal.
void AddCalibrationOptions(CLI::App& app, TrackSettings* request);
/// --body, --stature, --prior and --lifter.
void AddLearnedOptions(CLI::App& app, TrackSettings* request);
/// --solver, --threads, --max-iterations, --straight-knees and the switches that leave something out.
void AddSolveOptions(CLI::App& app, TrackSettings* request);

/// Binds every field of the request to its flag; defaults in --help are those of the struct. `quiet` is the verb's own.
void AddTrackOptions(CLI::App& app, TrackRequest* request, bool* quiet);

}  // namespace bodyloom
