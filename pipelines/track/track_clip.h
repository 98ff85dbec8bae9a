// SPDX-License-Identifier: Apache-2.0
/// A clip tracked, from files to files: detections in; track, overlay video and summary out.
#pragma once

#include "geometry/base/callbacks.h"
#include "pipelines/track/track_report.h"
#include "pipelines/track/track_request.h"

namespace bodyloom {

/// Checks the request, its inputs and its outputs, tracks, and writes what was requested. With request.plan nothing is
/// computed or written and the report holds the plan alone.
/// Throws RequestError for a request that contradicts itself, Cancelled (nothing is written after it), and
/// std::runtime_error naming a file that cannot be used, or saying that nothing could be tracked; then the JSON summary
/// says why.
TrackReport TrackClip(const TrackRequest& request, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
