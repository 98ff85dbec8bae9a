// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/track/solve_track.h"

#include <string>

#include "bodyloom/render/track_world.h"
#include "bodyloom/tracking/live/track_live.h"

namespace bodyloom {
namespace {

TrackSequenceOptions SolveOptionsOf(const TrackRequest& request, const TrackInputs& inputs) {
  TrackSequenceOptions options = request.solve;
  options.camera_knowledge = inputs.camera_knowledge;
  options.straight_knees_weight = StraightKneesWeight(request, inputs.keypoints ? inputs.keypoints->convention : "");
  if (inputs.joints_from_labels) options.part_labels = PartLabelOptions::LabelsAlone();
  return options;
}

LiveTrackerOptions LiveOptionsOf(const TrackRequest& request, const TrackSequenceOptions& solve) {
  LiveTrackerOptions live;
  live.lag = *request.live_lag;
  live.solve = solve;
  return live;
}

}  // namespace

TrackSequenceResult SolveTrack(const TrackRequest& request, const TrackInputs& inputs,
                               const PipelineCallbacks& callbacks, double share) {
  TrackSequenceOptions options = SolveOptionsOf(request, inputs);
  bool cancelled = false;
  std::string stage;
  options.progress = [&](const TrackProgress& at) {
    stage = at.stage;
    cancelled = !callbacks.GoesOn(stage, share * at.fraction);
    return !cancelled;
  };
  TrackSequenceResult result = request.live_lag ? TrackLive(inputs.ForTracker(), LiveOptionsOf(request, options))
                                                : TrackSequence(inputs.ForTracker(), options);
  if (cancelled || (!stage.empty() && !callbacks.GoesOn(stage, share))) throw Cancelled();
  if (result.summary.IsUsable() && !result.track.world) result.track.world = AssumedWorld(result.track.joints);
  return result;
}

std::vector<PlanEntry> PlanSolve(const TrackRequest& request, const TrackInputs& inputs) {
  const TrackSequenceOptions options = SolveOptionsOf(request, inputs);
  return request.live_lag ? PlanTrackLive(inputs.ForTracker(), LiveOptionsOf(request, options))
                          : PlanTrackSequence(inputs.ForTracker(), options);
}

}  // namespace bodyloom
