// SPDX-License-Identifier: Apache-2.0
/// Fills the track and the summary from the solved problem.
#pragma once

#include "tracking/problem/frame_accumulator.h"
#include "tracking/problem/sequence_problem.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"
#include "tracking/terms/observability.h"

namespace bodyloom {

/// Status by the amount of observations in the frame: tracked, weak or interpolated.
FrameStatus StatusOf(const FrameData& frame);

/// Fills result->track (poses, camera, status, joints, coco17) and the summary's errors and frame counts.
void FillTrack(const TrackSequenceInput& input, const SequenceProblem& problem, const ObservedLandmarks& landmarks,
               TrackSequenceResult* result);

/// Sets frames to lost that only smoothness holds: in each shot those before the first and after the last frame that is
/// observed, has an initial pose or a user's term; and those between two such frames more than kLongestHole_s apart.
/// Their values become NaN; the counts of the summary follow, and lost_in_holes.
void LoseUnseenFrames(const SequenceProblem& problem, TrackSequenceResult* result);

/// Appends the errors of rendered UV, silhouette and part labels to the summary, for those that ran; `residuals` are of
/// the whole clip (CostsByTerm()).
void SummariseImageTerms(const SequenceProblem& problem, const FrameResiduals& residuals,
                         TrackSequenceSummary* summary);

}  // namespace bodyloom
