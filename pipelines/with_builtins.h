// SPDX-License-Identifier: Apache-2.0
/// Defaults of the tracker: the built-in body, pose prior and lifter.
#pragma once

#include "bodyloom/tracking/live/live_tracker.h"
#include "bodyloom/tracking/track_sequence.h"

namespace bodyloom {

/// `input` with the built-in body (data_tools/body/builtin_body.h), pose prior and lifter (data_tools/learned) wherever
/// it names none, as `bodyloom track` has them. Who wants to track without one of them sets its pointer to null in what
/// comes back. 3D landmarks of one's own (TrackSequenceInput::lifted) take the lifter's place, and it is left as it is.
/// Weights and body live as long as the program. May be called by several threads.
TrackSequenceInput WithBuiltins(TrackSequenceInput input);

/// The same for the live tracker.
LiveTrackerInput WithBuiltins(LiveTrackerInput input);

}  // namespace bodyloom
