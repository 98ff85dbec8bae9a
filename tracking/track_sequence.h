// SPDX-License-Identifier: Apache-2.0
/// Fits one body to a clip: observations of one camera → a pose in every frame, one shape, and the camera.
/// The method is described in docs/tracking.md.
#pragma once

#include "tracking/clip/track_plan.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

/// The track of the person in the clip, with the built-in body, pose prior and lifter wherever the input names none
/// (WithBuiltins(): to go without one, its weight in the options is 0). FitClip() (tracking/clip/clip_fit.h) takes the
/// input as it is. Throws std::invalid_argument when the input contradicts itself (no observations, sizes that differ,
/// image size against camera); a clip in which nothing can be estimated gives status kFailure with a message.
TrackSequenceResult TrackSequence(const TrackSequenceInput& input, const TrackSequenceOptions& options = {});

}  // namespace bodyloom
