// SPDX-License-Identifier: Apache-2.0
/// The plan of a run: its terms and steps, with the reasons for including or skipping them.
#pragma once

#include <vector>

#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

/// The terms and steps that TrackSequence would run for this input, without running them.
std::vector<PlanEntry> PlanTrackSequence(const TrackSequenceInput& input, const TrackSequenceOptions& options);

}  // namespace bodyloom
