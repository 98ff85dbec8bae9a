// SPDX-License-Identifier: Apache-2.0
/// From the solved problem to the track and the summary that users see.
#pragma once

#include "tracking/observability.h"
#include "tracking/sequence_problem.h"
#include "tracking/track_sequence.h"

namespace bodyloom {

/// By how much of the frame is observed: tracked, weak or interpolated.
FrameStatus StatusOf(const FrameData& frame);

/// Fills result->track (poses, camera, status, joints, coco17) and the summary's errors and frame counts.
void FillTrack(const TrackSequenceInput& input, const SequenceProblem& problem, const ObservedLandmarks& landmarks,
               TrackSequenceResult* result);

}  // namespace bodyloom
