// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/track_sequence.h"

#include "bodyloom/tracking/builtin_models.h"
#include "bodyloom/tracking/clip/clip_fit.h"

namespace bodyloom {

TrackSequenceResult TrackSequence(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  return FitClip(WithBuiltins(input, options), options);
}

}  // namespace bodyloom
