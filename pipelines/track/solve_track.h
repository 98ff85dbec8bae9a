// SPDX-License-Identifier: Apache-2.0
/// Runs the tracker for a request whose inputs are in memory.
#pragma once

#include <vector>

#include "geometry/base/callbacks.h"
#include "pipelines/track/scene_inputs.h"
#include "pipelines/track/track_inputs.h"
#include "pipelines/track/track_request.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

/// The request's options for a track of these inputs.
TrackSequenceOptions SolveOptionsOf(const TrackRequest& request, const TrackInputs& inputs);

/// Tracks the inputs as requested, live or as a whole clip. A usable track gets a world, assumed if it was not observed
/// (render/view/floor.h). Progress ends at `share`. Throws Cancelled.
TrackSequenceResult SolveTrack(const TrackRequest& request, const TrackInputs& inputs,
                               const PipelineCallbacks& callbacks = {}, double share = 1);

/// The plan of SolveTrack(), without running it.
std::vector<PlanEntry> PlanSolve(const TrackRequest& request, const TrackInputs& inputs);

// Tracking for callers that need the track in memory: as TrackClip(), without writing results.

/// The track that TrackClip() would write for this request, byte for byte, and its summary; a clip in which nothing can
/// be estimated has status kFailure with a message. Data in `given` replace the request's files; the request's outputs
/// are ignored. Throws RequestError for a contradictory request, Cancelled, and std::runtime_error naming a file that
/// cannot be used.
TrackSequenceResult TrackToMemory(const TrackRequest& request, const GivenInMemory& given = {},
                                  const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
