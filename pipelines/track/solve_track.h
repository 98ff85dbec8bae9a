// SPDX-License-Identifier: Apache-2.0
/// What a request asks of the tracker, once its inputs are in memory.
#pragma once

#include <vector>

#include "geometry/base/callbacks.h"
#include "pipelines/track/scene_inputs.h"
#include "pipelines/track/track_inputs.h"
#include "pipelines/track/track_request.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

/// Tracks the inputs as the request says, live or as a whole; a usable track has a world, assumed where nothing showed
/// it (render/view/floor.h). Progress goes up to `share`. Throws Cancelled.
TrackSequenceResult SolveTrack(const TrackRequest& request, const TrackInputs& inputs,
                               const PipelineCallbacks& callbacks = {}, double share = 1);

/// What SolveTrack() would do: no computation.
std::vector<PlanEntry> PlanSolve(const TrackRequest& request, const TrackInputs& inputs);

// A clip tracked for a program that goes on with the track: as TrackClip(), without files of results.

/// The track that TrackClip() would write for this request, to the byte, and how it went; a clip in which nothing can
/// be estimated has the status kFailure with a message. What `given` holds takes the place of the request's files; the
/// request's outputs are not looked at. Throws RequestError for a request that contradicts itself, Cancelled, and
/// std::runtime_error naming a file that cannot be used.
TrackSequenceResult TrackToMemory(const TrackRequest& request, const GivenInMemory& given = {},
                                  const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
