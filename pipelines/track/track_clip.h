// SPDX-License-Identifier: Apache-2.0
/// Tracks a clip, from files to files: detections in; track, overlay video and summary out.
#pragma once

#include "geometry/base/callbacks.h"
#include "pipelines/track/track_report.h"
#include "pipelines/track/track_request.h"

namespace bodyloom {

/// Checks the request, its inputs and its outputs, tracks, and writes the requested files. With request.plan nothing is
/// computed or written, and the report holds only the plan. Throws RequestError for a contradictory request, Cancelled
/// (nothing is written after it), and std::runtime_error naming a file that cannot be used, or when nothing could be
/// tracked; the JSON summary then holds the reason.
TrackReport TrackClip(const TrackRequest& request, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
