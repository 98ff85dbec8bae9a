// SPDX-License-Identifier: Apache-2.0
/// The plan of a run: which terms and steps take part, and why.
#pragma once

#include <vector>

#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

/// What TrackSequence would do with this input: no computation.
std::vector<PlanEntry> PlanTrackSequence(const TrackSequenceInput& input, const TrackSequenceOptions& options);

}  // namespace bodyloom
