// SPDX-License-Identifier: Apache-2.0
/// What a request asks of the tracker, once its inputs are in memory.
#pragma once

#include <vector>

#include "bodyloom/pipelines/callbacks.h"
#include "bodyloom/pipelines/track/track_inputs.h"
#include "bodyloom/pipelines/track/track_request.h"
#include "bodyloom/tracking/track_sequence.h"

namespace bodyloom {

/// Tracks the inputs as the request says, live or as a whole; a usable track has a world, assumed where nothing showed it
/// (render/track_world.h). Progress goes up to `share`. Throws Cancelled.
TrackSequenceResult SolveTrack(const TrackRequest& request, const TrackInputs& inputs,
                               const PipelineCallbacks& callbacks = {}, double share = 1);

/// What SolveTrack() would do: no computation.
std::vector<PlanEntry> PlanSolve(const TrackRequest& request, const TrackInputs& inputs);

}  // namespace bodyloom
