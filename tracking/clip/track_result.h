// SPDX-License-Identifier: Apache-2.0
/// The track and the summary from the solved problem.
#pragma once

#include "tracking/problem/sequence_problem.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"
#include "tracking/terms/observability.h"

namespace bodyloom {

/// By how much of the frame is observed: tracked, weak or interpolated.
FrameStatus StatusOf(const FrameData& frame);

/// Fills result->track (poses, camera, status, joints, coco17) and the summary's errors and frame counts.
void FillTrack(const TrackSequenceInput& input, const SequenceProblem& problem, const ObservedLandmarks& landmarks,
               TrackSequenceResult* result);

/// Appends to the summary how the rendered UV and the silhouette with the part labels fit the whole clip, those that
/// ran.
void SummariseImageTerms(const SequenceProblem& problem, TrackSequenceSummary* summary);

}  // namespace bodyloom
