// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "apps/exit_code.h"
#include "apps/files.h"
#include "apps/interrupt.h"
#include "apps/overlay_video.h"
#include "apps/progress.h"
#include "apps/summary.h"
#include "apps/track_inputs.h"
#include "apps/track_options.h"
#include "apps/verbs.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/track_io.h"

namespace bodyloom {
namespace {

constexpr const char* kFooter =
    "Examples:\n"
    "  OpenPose's output folder and the video it was made from; the focal length is estimated:\n"
    "    bodyloom track --detections openpose_json/ --video clip.mp4 --out track.npz --overlay overlay.mp4\n"
    "  one calibrated camera of an AIST++ clip:\n"
    "    bodyloom track --detections keypoints2d/SEQ.pkl --view c01 --cameras cameras/ --out track.npz\n"
    "  a body of your own, and the numbers for a program:\n"
    "    bodyloom track --detections coco.json --image-size 1920x1080 --body SMPL_NEUTRAL.pkl --out t.npz --json "
    "t.json\n"
    "  what would be done, and why not the rest:\n"
    "    bodyloom track --detections coco.json --image-size 1920x1080 --plan\n\n";

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

void RunTrack(const TrackCommand& command) {
  CheckTrackOptions(command);
  for (const auto& [path, what] : std::initializer_list<std::pair<std::string, std::string>>{
           {command.detections, "detections"},
           {command.dense, "dense keypoints"},
           {command.cameras, "cameras"},
           {command.video, "video"},
           {command.body, "body model"},
           {command.init, "initialiser"},
           {command.prior == "none" ? "" : command.prior, "pose prior"}}) {
    RequireReadable(path, what);
  }
  const std::vector<std::string> outputs = {command.out, command.overlay, command.json};
  RequireDistinct(
      {command.detections, command.dense, command.cameras, command.video, command.body, command.init, command.prior},
      outputs);
  if (!command.plan) {
    for (const std::string& path : outputs) {
      RequireWritable(path);
    }
  }

  StageClock clock;
  clock.Begin("read");
  const TrackInputs inputs = LoadTrackInputs(command);
  TrackSequenceOptions options = command.solve;
  options.camera_knowledge = CameraKnowledgeOf(command);
  const std::vector<PlanEntry> own_plan = OwnPlan(command);
  if (command.plan) {
    std::vector<PlanEntry> plan = PlanTrackSequence(inputs.ForTracker(), options);
    plan.insert(plan.end(), own_plan.begin(), own_plan.end());
    std::cout << inputs.num_frames() << " frames would be tracked:\n" << ToText(plan);
    return;
  }
  ThrowIfInterrupted();

  TrackReport report;
  Track track;
  {
    Progress progress("tracking " + std::to_string(inputs.num_frames()) + " frames",
                      command.quiet ? Progress::Style::kSilent : Progress::DefaultStyle());
    const double solve_share = command.overlay.empty() ? 1 : kSolveShareWithOverlay;
    options.progress = [&](const TrackProgress& at) {
      progress.Update(at.stage, solve_share * at.fraction);
      return !IsInterrupted();
    };
    clock.Begin(kSolveStage);
    TrackSequenceResult result = TrackSequence(inputs.ForTracker(), options);
    ThrowIfInterrupted();
    report.solve = std::move(result.summary);
    track = std::move(result.track);
    report.solve.plan.insert(report.solve.plan.end(), own_plan.begin(), own_plan.end());
    if (report.solve.IsUsable()) {
      clock.Begin("write");
      WriteTrack(command.out, track);
      report.outputs.push_back(command.out);
      if (!command.overlay.empty()) {
        clock.Begin("overlay");
        WriteOverlay(command, inputs, track, solve_share, &progress, &report);
      }
    }
  }
  clock.End();
  report.num_frames = inputs.num_frames();
  report.detections = command.detections.empty() ? command.dense : command.detections;
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
  if (!command.quiet) {
    std::cout << ToText(report);
  }
}

}  // namespace

void AddTrackVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("track", "Fits a body to a clip: detections in, track out");
  verb->footer(std::string(kFooter) + kExitCodeHelp);
  auto command = std::make_shared<TrackCommand>();
  AddTrackOptions(*verb, command.get());
  verb->callback([command, action] { *action = [command] { RunTrack(*command); }; });
}

}  // namespace bodyloom
