// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/track_outputs.h"

#include <filesystem>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/track_io.h"
#include "geometry/base/parallel.h"
#include "geometry/scene/camera_path.h"
#include "geometry/scene/observations.h"
#include "pipelines/files.h"
#include "pipelines/page/write_clip_page.h"
#include "pipelines/track/overlay_video.h"

namespace bodyloom {
namespace {

/// Share of the solve where there is an overlay, which takes about as long.
constexpr double kSolveShareWithOverlay = 0.5;

void WriteOverlay(const TrackRequest& request, const TrackInputs& inputs, const Track& track, double start,
                  const PipelineCallbacks& callbacks, TrackReport* report) {
  OverlayVideo overlay;
  overlay.body = inputs.body.get();
  overlay.track = &track;
  overlay.detected = inputs.keypoints ? &*inputs.keypoints : nullptr;
  overlay.video = request.video;
  overlay.video_offset = request.video_offset;
  overlay.video_px_from_camera_px = inputs.camera.video_px_from_camera_px;
  overlay.side_view = request.side_view;
  overlay.reference = inputs.reference ? &*inputs.reference : nullptr;
  overlay.progress = [&](double fraction) { callbacks.Update("overlay", start + (1 - start) * fraction); };
  const OverlaySummary written = WriteOverlayVideo(request.overlay, overlay);
  if (written.frames_without_video > 0) {
    report->solve.plan.push_back({"video under " + std::to_string(written.frames_without_video) + " overlay frames",
                                  false, "the video has no frame at their time"});
  }
  if (!written.video_warning.empty()) callbacks.Message(written.video_warning);
  report->outputs.push_back(request.overlay);
}

void WriteReportPage(const TrackRequest& request, const TrackInputs& inputs, const Track& track,
                     const PipelineCallbacks& callbacks, TrackReport* report) {
  ClipPageRequest page;
  page.out = request.report;
  page.people = {{.number = request.person,
                  .body = inputs.body.get(),
                  .track = &track,
                  .summary = &report->solve,
                  .track_file = request.out}};
  page.video = request.video;
  page.video_offset = request.video_offset;
  page.video_px_from_camera_px = inputs.camera.video_px_from_camera_px;
  page.title = std::filesystem::path(report->detections).filename().string();
  page.summary = report->solve.BriefReport();
  if (report->room.frames > 0) page.summary += "room     " + report->room.BriefReport() + "\n";
  if (report->solve.flights.flights > 0) page.summary += "jumps    " + report->solve.flights.BriefReport() + "\n";
  callbacks.Begin("writing the page");
  WriteClipPage(page, callbacks);
  report->outputs.push_back(request.report);
}

InitialiserReport ReportOn(const InitialPoses& start, const TrackInputs& inputs, const Track& track) {
  InitialiserReport report;
  report.system = start.system;
  report.person = start.person;
  report.people = start.people;
  report.frames = start.frames;
  report.has_shape = start.has_shape;
  const KeypointSequence* keypoints = inputs.keypoints ? &*inputs.keypoints : nullptr;
  report.gives_landmarks = !start.landmarks.empty();
  const Track seen = TrackInCameras(*inputs.body, track);
  report.gain = report.gives_landmarks ? GainOverLandmarks(*inputs.body, keypoints, start.landmarks, start.camera, seen)
                                       : GainOverInitialiser(*inputs.body, keypoints, start.motion, start.camera, seen);
  return report;
}

}  // namespace

std::vector<PlanEntry> PlanOutputs(const TrackRequest& request) {
  return {{"overlay video", !request.overlay.empty(), request.overlay.empty() ? "no --overlay" : request.overlay},
          {"JSON summary", !request.json.empty(), request.json.empty() ? "no --json" : request.json},
          {"page", !request.report.empty(), request.report.empty() ? "no --report" : request.report}};
}

double SolveShare(const TrackRequest& request) { return request.overlay.empty() ? 1 : kSolveShareWithOverlay; }

void WriteResults(const TrackRequest& request, const TrackInputs& inputs, const Track& track, double solve_share,
                  const PipelineCallbacks& callbacks, StageClock* clock, TrackReport* report) {
  for (const PlanEntry& entry : PlanOutputs(request)) {
    report->solve.plan.push_back(entry);
  }
  if (report->solve.IsUsable()) {
    const std::string warning =
        MovingCameraWarning(report->camera_path, report->solve.camera_path, report->solve.ground);
    if (!warning.empty()) callbacks.Message(warning);
    clock->Begin("write");
    report->world = *track.world;
    report->room = RoomPhysicsOnGround(track, *inputs.body, ThreadsFor(request.solve.num_threads));
    if (inputs.initialiser) report->initialiser = ReportOn(*inputs.initialiser, inputs, track);
    WriteTrack(request.out, track);
    report->outputs.push_back(request.out);
    if (!request.overlay.empty()) {
      clock->Begin("overlay");
      WriteOverlay(request, inputs, track, solve_share, callbacks, report);
    }
    if (!request.report.empty()) {
      clock->Begin("page");
      WriteReportPage(request, inputs, track, callbacks, report);
    }
  }
  clock->End();
  report->seconds = clock->seconds();
  report->total_seconds = clock->total();
  report->peak_memory_bytes = PeakMemoryBytes();
  if (!request.json.empty()) {
    report->outputs.push_back(request.json);
    WriteFileAtomically(request.json, ToJson(*report));
  }
  if (!report->solve.IsUsable()) {
    throw NoPersonFound(report->detections + ": nothing could be tracked: " + report->solve.message);
  }
}

}  // namespace bodyloom
