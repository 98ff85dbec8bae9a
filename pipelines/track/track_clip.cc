// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/track_clip.h"

#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/stopwatch.h"
#include "pipelines/files.h"
#include "pipelines/report_text.h"
#include "pipelines/track/found_camera_motion.h"
#include "pipelines/track/solve_track.h"
#include "pipelines/track/track_inputs.h"
#include "pipelines/track/track_outputs.h"

namespace bodyloom {
namespace {

/// Everything that can be known to fail is made to fail now, before the long work.
void CheckFiles(const TrackRequest& request) {
  const std::vector<std::string> outputs = {request.out, request.overlay, request.json, request.report,
                                            request.camera_path_out};
  RequireDistinct(RequireTrackInputs(request), outputs);
  if (!request.plan) {
    for (const std::string& path : outputs) {
      RequireWritable(path);
    }
  }
}

/// Time of the solve from the rates of docs/lab/run_speed.md.
PlanEntry EstimatedTime(const TrackInputs& inputs) {
  constexpr double kJointsMs = 4, kLabelsMs = 20;  // a frame, of one core
  const double frame_ms = inputs.part_labels ? kLabelsMs : kJointsMs;
  return {"time, an estimate", true,
          Concatenate(Fixed(1e-3 * frame_ms * inputs.num_frames(), 1), " s of processor time, ", frame_ms,
                      " ms a frame as measured on an AMD EPYC (Zen 5)")};
}

PlanEntry PlanOfMotion(const TrackRequest& request, const TrackInputs& inputs) {
  const std::string why = request.live_lag ? "live tracking does not use it" : WhyNoCameraMotion(request);
  return {"camera's motion", why.empty(), why.empty() ? inputs.camera_path_report.motion : why};
}

}  // namespace

TrackReport TrackClip(const TrackRequest& request, const PipelineCallbacks& callbacks) {
  CheckTrackRequest(request);
  CheckFiles(request);
  StageClock clock;
  clock.Begin(DetectsPeople(request) ? "detect" : "read");
  const TrackInputs inputs = LoadTrackInputs(request, callbacks);
  TrackReport report;
  report.detections = !request.detections.empty()    ? request.detections
                      : !request.dense.empty()       ? request.dense
                      : !request.part_labels.empty() ? request.part_labels
                                                     : request.video;
  report.num_frames = inputs.num_frames();
  if (request.plan) {
    report.solve.plan = PlanSolve(request, inputs);
    if (!request.video.empty()) report.solve.plan.push_back(PlanOfMotion(request, inputs));
    for (const PlanEntry& entry : PlanOutputs(request)) report.solve.plan.push_back(entry);
    report.solve.plan.push_back(EstimatedTime(inputs));
    return report;
  }
  callbacks.Begin("tracking " + std::to_string(inputs.num_frames()) + " frames");
  const double solve_share = SolveShare(request);
  clock.Begin(kSolveStage);
  TrackSequenceResult result = SolveTrack(request, inputs, callbacks, solve_share);
  report.solve = std::move(result.summary);
  report.camera_path = inputs.camera_path_report;
  WriteResults(request, inputs, result.track, solve_share, callbacks, &clock, &report);
  return report;
}

}  // namespace bodyloom
