// SPDX-License-Identifier: Apache-2.0
/// The built-in body, pose prior and lifter, as defaults of the tracker.
#pragma once

#include "tracking/live/live_options.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"

namespace bodyloom {

/// `input` with the built-in body (data_tools/body/builtin_body.h), pose prior and lifter (data_tools/learned) wherever
/// it names none, as TrackSequence() uses them. No prior where options.prior_weight is 0; no lifter where
/// options.lifter_weight is 0, or where the user's 3D landmarks (TrackSequenceInput::lifted) replace it. Weights and
/// body live as long as the program. May be called by several threads.
TrackSequenceInput WithBuiltins(TrackSequenceInput input, const TrackSequenceOptions& options = {});

/// The same for the live tracker: always all three.
LiveTrackerInput WithBuiltins(LiveTrackerInput input);

}  // namespace bodyloom
