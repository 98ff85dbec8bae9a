// SPDX-License-Identifier: Apache-2.0
/// From the solved problem to the track and the summary that users see.
#pragma once

#include "bodyloom/tracking/observability.h"
#include "bodyloom/tracking/sequence_problem.h"
#include "bodyloom/tracking/track_sequence.h"

namespace bodyloom {

/// By how much of the frame is observed: tracked, weak or interpolated.
FrameStatus StatusOf(const FrameData& frame);

/// How a term of image residuals ended; `px` holds |residual| of each observation that had a say, pixels (0 of nothing).
TermSummary SummarizeTerm(const std::string& term, const std::vector<double>& px, int unmatched = 0);

/// Fills result->track (poses, camera, status, joints, coco17) and the summary's errors and frame counts.
void FillTrack(const TrackSequenceInput& input, const SequenceProblem& problem, const ObservedLandmarks& landmarks,
               TrackSequenceResult* result);

}  // namespace bodyloom
