// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/solve_track.h"

#include <string>

#include "pipelines/track/track_inputs.h"
#include "render/view/floor.h"
#include "tracking/clip/clip_fit.h"
#include "tracking/clip/track_plan.h"
#include "tracking/hands/fit_hands.h"
#include "tracking/live/track_live.h"

namespace bodyloom {
namespace {

LiveTrackerOptions LiveOptionsOf(const TrackRequest& request, const TrackSequenceOptions& solve) {
  LiveTrackerOptions live;
  live.lag = *request.live_lag;
  live.solve = solve;
  return live;
}

}  // namespace

TrackSequenceOptions SolveOptionsOf(const TrackRequest& request, const TrackInputs& inputs) {
  TrackSequenceOptions options = request.solve;
  options.camera_knowledge = inputs.camera_knowledge;
  options.straight_knees_weight = StraightKneesWeight(request, inputs.keypoints ? inputs.keypoints->convention : "");
  if (inputs.joints_from_labels) options.part_labels = PartLabelOptions::LabelsAlone();
  return options;
}

TrackSequenceResult SolveTrack(const TrackRequest& request, const TrackInputs& inputs,
                               const PipelineCallbacks& callbacks, double share) {
  TrackSequenceOptions options = SolveOptionsOf(request, inputs);
  bool cancelled = false;
  std::string stage;
  options.progress = [&](const TrackProgress& at) {
    stage = at.stage;
    cancelled = !callbacks.ReportProgress(stage, share * at.fraction);
    return !cancelled;
  };
  TrackSequenceResult result = request.live_lag ? TrackLive(inputs.ForTracker(), LiveOptionsOf(request, options))
                                                : FitClip(inputs.ForTracker(), options);
  if (cancelled || (!stage.empty() && !callbacks.ReportProgress(stage, share))) throw Cancelled();
  result.track.playback = inputs.playback;
  if (result.summary.IsUsable() && !result.track.world) result.track.world = AssumedWorld(result.track.joints);
  return result;
}

std::vector<PlanEntry> PlanSolve(const TrackRequest& request, const TrackInputs& inputs) {
  const TrackSequenceOptions options = SolveOptionsOf(request, inputs);
  if (request.live_lag) return PlanTrackLive(inputs.ForTracker(), LiveOptionsOf(request, options));
  std::vector<PlanEntry> plan = PlanTrackSequence(inputs.ForTracker(), options);
  if (request.detector.hands_and_faces == HandsAndFaceChoice::kOff) SkipHandsAndHead("switched off", &plan);
  return plan;
}

namespace {

/// Names the inputs given in memory in the request, for checks and messages.
TrackRequest NamedRequest(TrackRequest request, const GivenInMemory& given) {
  if (given.keypoints != nullptr) request.detections = "keypoints";
  if (given.camera) request.cameras = "camera";
  request.out = "track";
  request.overlay = request.json = request.report = request.reference = "";
  request.plan = request.side_view = false;
  return request;
}

}  // namespace

TrackSequenceResult TrackToMemory(const TrackRequest& request, const GivenInMemory& given,
                                  const PipelineCallbacks& callbacks) {
  const TrackRequest named = NamedRequest(request, given);
  CheckTrackRequest(named);
  TrackRequest files = named;
  if (given.keypoints != nullptr) files.detections = "";
  if (given.camera) files.cameras = "";
  RequireTrackInputs(files);
  const TrackInputs inputs = LoadTrackInputs(named, callbacks, given);
  callbacks.Begin("tracking " + std::to_string(inputs.num_frames()) + " frames");
  return SolveTrack(named, inputs, callbacks);
}

}  // namespace bodyloom
