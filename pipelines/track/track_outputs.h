// SPDX-License-Identifier: Apache-2.0
/// Files of a finished track that a request names, and the closing of its report.
#pragma once

#include <vector>

#include "geometry/base/callbacks.h"
#include "geometry/base/stopwatch.h"
#include "geometry/scene/track.h"
#include "pipelines/track/track_inputs.h"
#include "pipelines/track/track_report.h"
#include "pipelines/track/track_request.h"

namespace bodyloom {

/// The outputs as entries of the plan, beside the solver's own.
std::vector<PlanEntry> PlanOutputs(const TrackRequest& request);

/// Share of the solve in the progress.
double SolveShare(const TrackRequest& request);

/// Writes track, overlay, page and JSON summary of a solve whose summary is in the report, adds to the report what
/// follows from the track, and ends the clock. The track of a usable solve has a world. Progress goes on from
/// `solve_share`. Throws NoPersonFound if the solve is not usable, when only the JSON summary was written; Cancelled;
/// std::runtime_error naming a file that cannot be written.
void WriteResults(const TrackRequest& request, const TrackInputs& inputs, const Track& track, double solve_share,
                  const PipelineCallbacks& callbacks, StageClock* clock, TrackReport* report);

}  // namespace bodyloom
