// SPDX-License-Identifier: Apache-2.0
#include "tracking/initialise/view_observations.h"

#include "geometry/base/parallel.h"
#include "tracking/initialise/initial_states.h"
#include "tracking/initialise/outlier_frames.h"
#include "tracking/initialise/swap_repair.h"

namespace bodyloom {

std::vector<ViewObservations> ObserveViews(const TrackSequenceInput& input, const FrameLayout& layout,
                                           const TrackSequenceOptions& options) {
  std::vector<ViewObservations> views;
  if (input.views == nullptr) return views;
  const bool lifts = WhyNotLifted(input, options).empty();
  LiftOptions lift;
  lift.num_threads = ThreadsFor(options.num_threads);
  for (size_t v = 0; v < input.views->size(); ++v) {
    ViewObservations& view = views.emplace_back();
    view.keypoints = *(*input.views)[v].keypoints;
    CleanKeypoints(&view.keypoints);
    if (!lifts) continue;
    const FrameLayout& local = *layout.views[v].local;
    view.lifted = LiftKeypoints(view.keypoints, local.camera, local.knowledge == CameraKnowledge::kKnown,
                                FindCuts(view.keypoints), *input.lifter, lift);
  }
  return views;
}

}  // namespace bodyloom
