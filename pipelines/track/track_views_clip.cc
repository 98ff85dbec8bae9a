// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/track_views_clip.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "data_tools/observations/rig_io.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/base/stopwatch.h"
#include "geometry/scene/camera_path.h"
#include "pipelines/files.h"
#include "pipelines/track/solve_track.h"
#include "pipelines/track/track_outputs.h"
#include "pipelines/track/view_hands.h"
#include "render/view/floor.h"
#include "tracking/clip/track_plan.h"
#include "tracking/hands/fit_hands.h"
#include "tracking/hands/hands_in_views.h"
#include "tracking/initialise/swap_repair.h"
#include "tracking/rig/track_views.h"

namespace bodyloom {
namespace {

std::string RigFileOf(const TrackViewsRequest& request) {
  if (!request.rig_out.empty() || request.out.empty()) return request.rig_out;
  return (std::filesystem::path(request.out).parent_path() / "rig.json").string();
}

/// Everything that can be known to fail is made to fail now, before the long work.
void CheckFilesOfViews(const TrackViewsRequest& request) {
  const std::string rig = RigFileOf(request);
  std::error_code ignored;
  if (request.rig_out.empty() && std::filesystem::equivalent(rig, request.cameras, ignored)) {
    if (!request.plan)
      throw RequestError("--cameras " + request.cameras + " would be overwritten: give --rig-out FILE");
    RequireViewInputs(request);
    return;
  }
  const std::vector<std::string> outputs = {request.out, rig, request.overlay, request.json, request.report};
  RequireDistinct(RequireViewInputs(request), outputs);
  if (request.plan) return;
  for (const std::string& path : outputs) RequireWritable(path);
}

std::vector<ObservedView> ObservedViews(const TrackViewsRequest& request, const std::vector<ViewInputs>& views) {
  std::vector<ObservedView> observed;
  for (const ViewInputs& view : views) {
    const TrackSequenceInput input = view.inputs.ForTracker();
    ObservedView& one = observed.emplace_back();
    one.keypoints = input.keypoints;
    one.knowledge = view.inputs.camera_knowledge;
    one.camera = input.camera;
    one.focal_prior = input.focal_prior;
    if (request.same_lens) one.focal_ratio_log_sigma = kSameLensLogSigma;
    one.picture_vertical = input.picture_vertical;
    one.camera_from_own = input.camera_from_scene;
    one.camera_scale_m = input.camera_scale_m;
    one.camera_from_rig = view.camera_from_rig;
    if (view.clock.HasClock()) one.offset_s = 0;  // its timestamps are of the first view's clock
  }
  return observed;
}

/// The plan of the joint fit: what all views share, and what is estimated of each, by name.
std::vector<PlanEntry> PlanOfViews(const TrackViewsRequest& request, const std::vector<ViewInputs>& views) {
  std::vector<ViewInput> others;
  for (const ObservedView& view : ObservedViews(request, views)) {
    ViewInput& other = others.emplace_back();
    other.keypoints = view.keypoints;
    other.knowledge = view.knowledge;
    other.camera = view.camera;
    other.focal_ratio_log_sigma = view.focal_ratio_log_sigma;
    other.camera_from_own = view.camera_from_own;
    other.pose_known = view.camera_from_rig.has_value();
    other.clock_known = view.offset_s.has_value();
  }
  others.erase(others.begin());
  TrackSequenceInput input = views[0].inputs.ForTracker();
  input.views = &others;
  std::vector<PlanEntry> plan = PlanTrackSequence(input, SolveOptionsOf(request, views[0].inputs));
  std::vector<HandsOfView> hands;
  for (const ViewInputs& view : views) hands.emplace_back().seen = view.inputs.hands_and_face;
  ReplanHandsAndHead(PlanHandsInViews(*input.body, hands), &plan);
  if (request.detector.hands_and_faces == HandsAndFaceChoice::kOff) SkipHandsAndHead("switched off", &plan);
  for (size_t v = 1; v < views.size(); ++v) {
    for (PlanEntry& entry : plan) {
      if (entry.what != "view " + std::to_string(v + 1)) continue;
      entry.what = "view " + views[v].name;
      entry.why = std::to_string(views[v].inputs.num_frames()) + " frames, " + entry.why;
    }
  }
  const bool focal_known = views[0].inputs.camera_knowledge == CameraKnowledge::kKnown;
  plan.insert(plan.begin(), {{"shared by " + std::to_string(views.size()) + " views", true,
                              "shape, and the pose of every frame of the first"},
                             {"view " + views[0].name, true,
                              std::to_string(views[0].inputs.num_frames()) + " frames, its axes and clock are the " +
                                  "track's" + (focal_known ? "" : "; focal length estimated")}});
  return plan;
}

std::vector<ViewReport> ReportOnViews(const std::vector<ViewInputs>& views, const TrackViewsResult& result) {
  const TrackSequenceSummary& joint = result.joint.summary;
  const std::vector<double>& times = views[0].inputs.timestamps();
  const double middle_s = 0.5 * (times.front() + times.back());
  std::vector<ViewReport> reports = {ReportOnFirstView(joint, result.joint.track.camera, middle_s)};
  reports[0].frames = views[0].inputs.num_frames();
  size_t used = 0;
  for (size_t v = 1; v < views.size(); ++v) {
    if (result.summary.used[v] != 0) {
      reports.push_back(ReportOnView(joint.views[used++], views[v].clock, middle_s));
      reports.back().doubt = DoubtAbout(reports.back(), reports[0]);
      continue;
    }
    const std::string& why = result.summary.alignment[v].why;
    reports.emplace_back().left_out = why.empty() ? "the person is not seen there" : why;
  }
  for (size_t v = 0; v < views.size(); ++v) {
    reports[v].camera.name = views[v].name;
    reports[v].detections = views[v].detections;
    reports[v].fps = views[v].fps;
  }
  return reports;
}

/// Hands and head of the joint track, by the views that show them. Cameras that move tell nothing of them.
void FitHandsOf(const std::vector<ViewInputs>& views, const std::vector<ViewReport>& reports, int num_threads,
                TrackSequenceResult* joint) {
  std::vector<HandsOfView> hands;
  const std::vector<double>& times = joint->track.motion.timestamps;
  for (size_t v = 0; v < views.size(); ++v) {
    const TrackInputs& inputs = views[v].inputs;
    const bool used = v == 0 || (reports[v].left_out.empty() && inputs.camera_from_scene.empty());
    hands.push_back(used ? HandsOfViewAt(reports[v].camera, inputs.hands_and_face, inputs.timestamps(),
                                         v == 0 || views[v].clock.HasClock(), times, views[v].fps)
                         : HandsOfView());
  }
  if (std::all_of(hands.begin(), hands.end(), [](const HandsOfView& view) { return view.seen.empty(); })) return;
  FitHandsInViews(*views[0].inputs.body, hands, FindCuts(*views[0].inputs.keypoints), num_threads, joint);
}

}  // namespace

TrackReport TrackViewsClip(const TrackViewsRequest& request, const PipelineCallbacks& callbacks) {
  CheckTrackViewsRequest(request);
  CheckFilesOfViews(request);
  StageClock clock;
  clock.Begin("read");
  const std::vector<ViewInputs> views = LoadViewInputs(request, callbacks);
  const TrackInputs& first = views[0].inputs;
  TrackReport report;
  report.detections = views[0].detections;
  report.num_frames = first.num_frames();
  if (request.plan) {
    report.solve.plan = PlanOfViews(request, views);
    for (const PlanEntry& entry : PlanOutputs(request)) report.solve.plan.push_back(entry);
    return report;
  }
  callbacks.Begin("tracking " + std::to_string(first.num_frames()) + " frames in " + std::to_string(views.size()) +
                  " views");
  const double solve_share = SolveShare(request);
  clock.Begin(kSolveStage);
  TrackSequenceOptions options = SolveOptionsOf(request, first);
  bool cancelled = false;
  options.progress = [&](const TrackProgress& at) {
    cancelled = !callbacks.ReportProgress(at.stage, solve_share * at.fraction);
    return !cancelled;
  };
  TrackViewsResult result = TrackViews(ObservedViews(request, views), first.ForTracker(), options);
  if (cancelled) throw Cancelled();
  result.joint.track.playback = first.playback;
  TrackSequenceSummary& joint = result.joint.summary;
  joint.seconds.emplace_back("views alone", result.summary.seconds_alone);
  if (joint.IsUsable()) {
    if (!result.joint.track.world) result.joint.track.world = AssumedWorld(result.joint.track.joints);
    report.views = ReportOnViews(views, result);
    FitHandsOf(views, report.views, ThreadsFor(request.solve.num_threads), &result.joint);
  }
  WarnAboutViews(report.views, "another person", callbacks);
  report.solve = std::move(joint);
  if (report.solve.IsUsable()) {
    report.outputs.push_back(RigFileOf(request));
    WriteRig(report.outputs.back(), RigOf(report.views));
  }
  WriteResults(request, first, result.joint.track, solve_share, callbacks, &clock, &report);
  return report;
}

}  // namespace bodyloom
