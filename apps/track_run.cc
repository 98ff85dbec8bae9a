// SPDX-License-Identifier: Apache-2.0
#include "apps/track_run.h"

#include "apps/exit_code.h"
#include "apps/interrupt.h"
#include "apps/overlay_video.h"
#include "apps/progress.h"
#include "apps/track_inputs.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/pipelines/files.h"
#include "bodyloom/tracking/live/track_live.h"

namespace bodyloom {
namespace {

/// How the bar is shared out: the overlay takes about as long as the solve.
constexpr double kSolveShareWithOverlay = 0.5;

void WriteOverlay(const TrackCommand& command, const TrackInputs& inputs, const Track& track, double start,
                  Progress* progress, TrackReport* report) {
  OverlayVideo overlay;
  overlay.body = inputs.body.get();
  overlay.track = &track;
  overlay.detected = inputs.keypoints ? &*inputs.keypoints : nullptr;
  overlay.video = command.video;
  overlay.video_offset = command.video_offset;
  overlay.video_px_from_camera_px = inputs.camera.video_px_from_camera_px;
  overlay.side_view = command.side_view;
  overlay.reference = inputs.reference ? &*inputs.reference : nullptr;
  overlay.progress = [&](double fraction) {
    ThrowIfInterrupted();
    progress->Update("overlay", start + (1 - start) * fraction);
  };
  const OverlaySummary written = WriteOverlayVideo(command.overlay, overlay);
  if (written.frames_without_video > 0) {
    report->solve.plan.push_back({"video under " + std::to_string(written.frames_without_video) + " overlay frames",
                                  false, "the video has no frame at their time"});
  }
  report->outputs.push_back(command.overlay);
}

/// The command's own steps, beside the solver's.
std::vector<PlanEntry> OwnPlan(const TrackCommand& command) {
  return {{"overlay video", !command.overlay.empty(), command.overlay.empty() ? "no --overlay" : command.overlay},
          {"JSON summary", !command.json.empty(), command.json.empty() ? "no --json" : command.json}};
}

/// Everything that can be known to fail is made to fail now, before the long work.
void CheckFiles(const TrackCommand& command) {
  const std::vector<std::pair<std::string, std::string>> named_inputs = {
      {command.detections, "detections"},
      {command.dense, "dense keypoints"},
      {command.part_labels, "part labels"},
      {command.cameras, "cameras"},
      {command.video, "video"},
      {command.body, "body model"},
      {command.init, "initialiser"},
      {command.prior == "none" ? "" : command.prior, "pose prior"},
      {command.lifter == "none" ? "" : command.lifter, "lifter"},
      {command.reference, "reference track"}};
  std::vector<std::string> inputs;
  for (const auto& [path, what] : named_inputs) {
    RequireReadable(path, what);
    inputs.push_back(path);
  }
  const std::vector<std::string> outputs = {command.out, command.overlay, command.json};
  RequireDistinct(inputs, outputs);
  if (!command.plan) {
    for (const std::string& path : outputs) {
      RequireWritable(path);
    }
  }
}

TrackSequenceOptions OptionsFor(const TrackCommand& command, const TrackInputs& inputs) {
  TrackSequenceOptions options = command.solve;
  if (inputs.joints_from_labels) options.part_labels = PartLabelOptions::LabelsAlone();
  return options;
}

LiveTrackerOptions LiveOptions(const TrackCommand& command, const TrackSequenceOptions& solve) {
  LiveTrackerOptions live;
  live.lag = *command.live_lag;
  live.solve = solve;
  return live;
}

TrackSequenceResult Solve(const TrackCommand& command, const TrackInputs& inputs, double share, Progress* progress) {
  TrackSequenceOptions options = OptionsFor(command, inputs);
  options.camera_knowledge = CameraKnowledgeOf(command);
  options.progress = [&](const TrackProgress& at) {
    progress->Update(at.stage, share * at.fraction);
    return !IsInterrupted();
  };
  TrackSequenceResult result = command.live_lag ? TrackLive(inputs.ForTracker(), LiveOptions(command, options))
                                                : TrackSequence(inputs.ForTracker(), options);
  ThrowIfInterrupted();
  return result;
}

std::vector<PlanEntry> WholePlan(const TrackCommand& command, const TrackInputs& inputs) {
  TrackSequenceOptions options = OptionsFor(command, inputs);
  options.camera_knowledge = CameraKnowledgeOf(command);
  std::vector<PlanEntry> plan = command.live_lag ? PlanTrackLive(inputs.ForTracker(), LiveOptions(command, options))
                                                 : PlanTrackSequence(inputs.ForTracker(), options);
  const std::vector<PlanEntry> own = OwnPlan(command);
  plan.insert(plan.end(), own.begin(), own.end());
  return plan;
}

}  // namespace

TrackReport RunTrack(const TrackCommand& command) {
  CheckTrackOptions(command);
  CheckFiles(command);
  StageClock clock;
  clock.Begin("read");
  const TrackInputs inputs = LoadTrackInputs(command);
  TrackReport report;
  report.detections = !command.detections.empty() ? command.detections
                      : !command.dense.empty()    ? command.dense
                                                  : command.part_labels;
  report.num_frames = inputs.num_frames();
  if (command.plan) {
    report.solve.plan = WholePlan(command, inputs);
    return report;
  }
  ThrowIfInterrupted();
  {
    Progress progress("tracking " + std::to_string(inputs.num_frames()) + " frames",
                      command.quiet ? Progress::Style::kSilent : Progress::DefaultStyle());
    const double solve_share = command.overlay.empty() ? 1 : kSolveShareWithOverlay;
    clock.Begin(kSolveStage);
    TrackSequenceResult result = Solve(command, inputs, solve_share, &progress);
    report.solve = std::move(result.summary);
    for (const PlanEntry& entry : OwnPlan(command)) {
      report.solve.plan.push_back(entry);
    }
    if (report.solve.IsUsable()) {
      clock.Begin("write");
      WriteTrack(command.out, result.track);
      report.outputs.push_back(command.out);
      if (!command.overlay.empty()) {
        clock.Begin("overlay");
        WriteOverlay(command, inputs, result.track, solve_share, &progress, &report);
      }
    }
  }
  clock.End();
  report.seconds = clock.seconds();
  report.total_seconds = clock.total();
  report.peak_memory_bytes = PeakMemoryBytes();
  if (!command.json.empty()) {
    report.outputs.push_back(command.json);
    WriteFileAtomically(command.json, ToJson(report));
  }
  if (!report.solve.IsUsable()) {
    throw std::runtime_error(report.detections + ": nothing could be tracked: " + report.solve.message);
  }
  return report;
}

}  // namespace bodyloom
