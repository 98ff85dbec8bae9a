// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/track_sequence.h"

#include "bodyloom/tracking/clip/clip_fit.h"
#include "bodyloom/tracking/problem/input_checks.h"

namespace bodyloom {

TrackSequenceResult TrackSequence(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  CheckInput(input, options);
  TrackSequenceResult result;
  ClipFit fit(input, options, &result.summary);
  if (!fit.FindStart()) return result;
  fit.Observe();
  fit.FitCoarseFrames();
  fit.FitAllFrames();
  fit.FinishWithCeres();
  fit.Finish(&result);
  return result;
}

}  // namespace bodyloom
