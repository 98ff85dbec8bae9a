// SPDX-License-Identifier: Apache-2.0
/// Runs the live tracker on a whole clip, frame by frame, as if it came from a camera.
#pragma once

#include "tracking/live/live_tracker.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

/// As TrackSequence(), from 2D joints, dense keypoints and an initialiser (part labels are not used). The track holds
/// the poses that Push() returned; shape and focal length are those known at the end. The summary's plan lists the
/// differences; its seconds are one stage, "live".
TrackSequenceResult TrackLive(const TrackSequenceInput& input, const LiveTrackerOptions& options);

/// The plan of TrackLive() for this input, without running it.
std::vector<PlanEntry> PlanTrackLive(const TrackSequenceInput& input, const LiveTrackerOptions& options);

/// Frame t of the input's sequences as observations for Push().
LiveObservations ObservationsAt(const TrackSequenceInput& input, int t);

/// The constant input of a live tracker for this clip.
LiveTrackerInput LiveInputFor(const TrackSequenceInput& input);

}  // namespace bodyloom
