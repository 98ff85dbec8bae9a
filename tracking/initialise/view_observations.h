// SPDX-License-Identifier: Apache-2.0
/// The observations of the other views of a clip, cleaned, and what the lifter makes of them.
#pragma once

#include <vector>

#include "geometry/scene/observations.h"
#include "tracking/lifter/lift_keypoints.h"
#include "tracking/problem/frame_layout.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"

namespace bodyloom {

struct ViewObservations {
  KeypointSequence keypoints;
  std::vector<LiftedFrame>
      lifted;  ///< of each of its own frames, in its camera's frame; empty: the lifter does not run
};

/// Of every view of the input, whose cameras are those of the layout.
std::vector<ViewObservations> ObserveViews(const TrackSequenceInput& input, const FrameLayout& layout,
                                           const TrackSequenceOptions& options);

}  // namespace bodyloom
