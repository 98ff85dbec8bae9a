// SPDX-License-Identifier: Apache-2.0
/// A whole clip through the live tracker, frame by frame, as if it came from a camera.
#pragma once

#include "tracking/live/live_tracker.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

/// As TrackSequence(), from 2D joints, dense keypoints and an initialiser (part labels are left out). The track holds
/// the poses that Push() handed out; shape and focal length are those known at the end. The summary's
/// plan says what differs; its seconds are one stage, "live".
TrackSequenceResult TrackLive(const TrackSequenceInput& input, const LiveTrackerOptions& options);

/// What TrackLive() would do with this input: no computation.
std::vector<PlanEntry> PlanTrackLive(const TrackSequenceInput& input, const LiveTrackerOptions& options);

/// Frame t of sequences as it would have come.
LiveObservations ObservationsAt(const TrackSequenceInput& input, int t);

/// What a live tracker must know beforehand.
LiveTrackerInput LiveInputFor(const TrackSequenceInput& input);

}  // namespace bodyloom
