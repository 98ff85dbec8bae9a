// SPDX-License-Identifier: Apache-2.0
#include "tracking/track_sequence.h"

#include "tracking/builtin_models.h"
#include "tracking/clip/clip_fit.h"

namespace bodyloom {

TrackSequenceResult TrackSequence(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  return FitClip(WithBuiltins(input, options), options);
}

}  // namespace bodyloom
