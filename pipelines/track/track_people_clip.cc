// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/track/track_people_clip.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/data_tools/observations/nothing_to_track.h"
#include "bodyloom/data_tools/observations/part_labels.h"
#include "bodyloom/data_tools/observations/people_npz.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/pipelines/files.h"
#include "bodyloom/pipelines/page/write_clip_page.h"
#include "bodyloom/pipelines/peak_memory.h"
#include "bodyloom/pipelines/track/detected_people.h"
#include "bodyloom/pipelines/track/overlay_video.h"
#include "bodyloom/pipelines/track/scene_inputs.h"
#include "bodyloom/pipelines/track/track_inputs.h"
#include "bodyloom/pipelines/video/track_video.h"
#include "bodyloom/tracking/people/track_people.h"

namespace bodyloom {
namespace {

std::string FileIn(const TrackPeopleClipRequest& request, const std::string& name) {
  return (std::filesystem::path(request.out) / name).string();
}

std::string TrackFile(const TrackPeopleClipRequest& request, int number) {
  return FileIn(request, Concatenate("person_", number, ".npz"));
}

std::string MaskFile(const TrackPeopleClipRequest& request, int number) {
  return FileIn(request, Concatenate("mask_", number, ".npz"));
}

void CheckRequest(const TrackPeopleClipRequest& request) {
  if (request.out.empty()) throw RequestError("--out is required: the folder for the results");
  if (request.track.video.empty()) throw RequestError("the video is required");
  if (request.person && request.max_people > 0) {
    throw RequestError("--person and --people both choose who is tracked, expected one of them");
  }
  if (request.masks && !request.track.use_mask) {
    throw RequestError("--masks writes what --no-mask leaves out, expected one of them");
  }
  if (request.masks && !request.track.detector.pose_model.empty()) {
    throw RequestError("--masks are BlazePose's: leave them out with --pose-model");
  }
  if (request.track.stature_m > 0 && !request.person && request.max_people != 1) {
    throw RequestError("--stature is one person's: say whose with --person, or give --people 1");
  }
  if (request.track.camera == "weak") {
    throw RequestError("weak perspective puts nobody into a common space: use track for one person at a time");
  }
  if (request.track.live_lag) throw RequestError("everybody together cannot be tracked live: use track --live");
  TrackRequest track = request.track;
  track.out = TrackFile(request, 0);
  track.overlay = request.overlay ? FileIn(request, "overlay.mp4") : "";
  CheckTrackRequest(track);
  BODYLOOM_CHECK(DetectsPeople(track), "the request holds other observations than a video");
  RequireDistinct(
      RequireTrackInputs(track),
      {FileIn(request, "detections.npz"), track.out, request.masks ? MaskFile(request, 0) : "", track.overlay,
       request.report ? FileIn(request, "report.html") : "", FileIn(request, "summary.json")});
  RequireWritableFolder(request.out);
}

/// Numbers of those to be tracked, in LinkPeople()'s order.
std::vector<int> ChoosePeople(const TrackPeopleClipRequest& request, const DetectedClip& clip,
                              const std::vector<PersonTrack>& everybody) {
  const std::string& video = request.track.video;
  if (request.person) {
    PersonOf(clip.people, *request.person, video);  // throws when there is no such person
    return {*request.person};
  }
  const std::vector<double>& times = clip.people.timestamps;
  const double fps = VideoFrameRate(times);
  const double least_frames = std::min(request.least_seconds * fps, 0.5 * double(times.size()));
  std::vector<int> chosen;
  for (size_t i = 0; i < everybody.size(); ++i) {
    if (request.max_people > 0 && int(chosen.size()) == request.max_people) break;
    if (double(everybody[i].detections.size()) >= least_frames) chosen.push_back(int(i));
  }
  if (chosen.empty()) {
    throw NothingToTrack(everybody.empty() ? Concatenate(video, ": nobody was found in ", times.size(), " frames")
                                           : Concatenate(video, ": nobody was seen for ", request.least_seconds,
                                                         " s; --person 0 takes whoever was seen most"));
  }
  return chosen;
}

/// Tracks them; progress is that of all fits.
TrackPeopleResult Solve(const TrackPeopleClipRequest& request, const SceneInputs& scene,
                        const std::vector<DetectedObservations>& seen,
                        const std::vector<std::vector<CameraPose>>& cameras, const PipelineCallbacks& callbacks) {
  std::vector<TrackSequenceInput> inputs;
  for (const DetectedObservations& person : seen) {
    TrackSequenceInput& input = inputs.emplace_back(scene.ForTracker());
    input.keypoints = &person.keypoints;
    input.part_labels = person.mask ? &*person.mask : nullptr;
    if (cameras.empty()) continue;
    input.camera_from_scene = &cameras[inputs.size() - 1];
    input.camera_scale_m = CameraScaleOf(request.track, *scene.camera_path);
  }
  TrackSequenceOptions options = request.track.solve;
  options.camera_knowledge = scene.camera_knowledge;
  options.straight_knees_weight = StraightKneesWeight(request.track, seen.front().keypoints.convention);
  bool cancelled = false;
  options.progress = [&](const TrackProgress& at) {
    cancelled = !callbacks.GoesOn(at.stage, at.fraction);
    return !cancelled;
  };
  TrackPeopleResult result = TrackPeople(std::move(inputs), options);
  if (cancelled) throw Cancelled();
  return result;
}

void WriteOverlay(const TrackPeopleClipRequest& request, const SceneInputs& scene, const TrackPeopleResult& result,
                  const std::vector<DetectedObservations>& seen, const PipelineCallbacks& callbacks,
                  TrackPeopleReport* report) {
  PeopleOverlayVideo overlay;
  for (size_t i = 0; i < seen.size(); ++i) {
    if (report->people[i].track.empty()) continue;
    overlay.people.push_back({.body = scene.body.get(),
                              .track = &result.people[i].track,
                              .detected = &seen[i].keypoints,
                              .number = report->people[i].number});
  }
  overlay.video = request.track.video;
  overlay.video_px_from_camera_px = scene.camera.video_px_from_camera_px;
  overlay.side_view = request.track.side_view;
  const SharedScene& shared = result.summary.scene;
  if (shared.has_up) overlay.up_in_camera = shared.ground.up;
  if (shared.has_up && shared.ground.has_plane) {
    overlay.ground = Floor{-shared.ground.camera_height_m * shared.ground.up, shared.ground.up};
  }
  callbacks.Begin("drawing the overlay");
  overlay.progress = [&](double fraction) { callbacks.Update("overlay", fraction); };
  const std::string path = FileIn(request, "overlay.mp4");
  WritePeopleOverlayVideo(path, overlay);
  report->outputs.push_back(path);
}

void WriteReportPage(const TrackPeopleClipRequest& request, const SceneInputs& scene, const TrackPeopleResult& result,
                     const PipelineCallbacks& callbacks, TrackPeopleReport* report) {
  ClipPageRequest page;
  page.out = FileIn(request, "report.html");
  for (size_t i = 0; i < report->people.size(); ++i) {
    const TrackedPerson& person = report->people[i];
    if (person.track.empty()) continue;
    page.people.push_back({.number = person.number,
                           .body = scene.body.get(),
                           .track = &result.people[i].track,
                           .summary = &person.solve,
                           .track_file = person.track});
  }
  TrackPeopleReport told = *report;
  told.outputs.clear();  // files are where the page is
  page.video = request.track.video;
  page.video_px_from_camera_px = scene.camera.video_px_from_camera_px;
  page.title = std::filesystem::path(request.track.video).filename().string();
  page.summary = ToText(told);
  callbacks.Begin("writing the page");
  WriteClipPage(page, callbacks);
  report->outputs.push_back(page.out);
}

/// What the detections say of the clip and of those chosen.
TrackPeopleReport StartReport(const TrackPeopleClipRequest& request, const DetectedClip& clip,
                              const std::vector<PersonTrack>& everybody, const std::vector<int>& chosen) {
  TrackPeopleReport report;
  report.video = request.track.video;
  report.width = clip.people.image_width;
  report.height = clip.people.image_height;
  report.num_frames = int(clip.people.frames.size());
  report.fps = VideoFrameRate(clip.people.timestamps);
  report.network = FrameDetectorName(request.track.detector);
  const std::vector<FoundPerson> found = FoundPeople(clip.people, everybody);
  report.num_found = int(found.size());
  for (const int number : chosen) {
    TrackedPerson& person = report.people.emplace_back();
    person.number = number;
    person.seen = found[size_t(number)];
  }
  return report;
}

}  // namespace

TrackPeopleReport TrackPeopleClip(const TrackPeopleClipRequest& request, const PipelineCallbacks& callbacks) {
  CheckRequest(request);
  StageClock clock;
  clock.Begin("read");
  SceneInputs scene = LoadSceneInputs(request.track);
  UseFocal(request.track, &scene.camera.camera);
  clock.Begin("detect");
  const DetectedClip clip = DetectForTracking(request.track, callbacks, request.max_people);
  const std::vector<PersonTrack> everybody = LinkPeople(clip.people);
  const std::vector<int> chosen = ChoosePeople(request, clip, everybody);
  TrackPeopleReport report = StartReport(request, clip, everybody, chosen);
  clock.Begin("write");
  report.outputs.push_back(FileIn(request, "detections.npz"));
  WritePeople(report.outputs.back(), clip.people);
  for (const int number : request.masks ? chosen : std::vector<int>()) {
    report.outputs.push_back(MaskFile(request, number));
    WriteMask(report.outputs.back(), MaskOfPerson(clip, everybody[size_t(number)]));
  }

  std::vector<DetectedObservations> seen;
  for (const int number : chosen) {
    const PersonTrack& person = everybody[size_t(number)];
    seen.push_back(ObservationsOf(clip, person, SpanOf(person), request.track, scene));
  }
  std::vector<std::vector<CameraPose>> cameras;  // of each person's frames
  for (size_t i = 0; scene.camera_path && i < seen.size(); ++i) {
    cameras.push_back(CamerasAt(request.track, *scene.camera_path, clip.people.timestamps, seen[i].keypoints.timestamps,
                                &report.camera_path));
  }
  callbacks.Begin(Concatenate("tracking ", seen.size(), seen.size() == 1 ? " person" : " people"));
  clock.Begin("track");
  const TrackPeopleResult result = Solve(request, scene, seen, cameras, callbacks);
  report.scene = result.summary.scene;
  clock.Begin("write");
  bool any_tracked = false;
  for (size_t i = 0; i < seen.size(); ++i) {
    TrackedPerson& person = report.people[i];
    person.solve = result.people[i].summary;
    person.hidden = result.summary.hidden[i];
    person.fitted_again = result.summary.fitted_again[i] != 0;
    if (!person.solve.IsUsable()) continue;
    if (!any_tracked) {
      report.camera_scale = person.solve.camera_path;
      const std::string warning = MovingCameraWarning(person.solve.camera_path, person.solve.ground);
      if (!warning.empty()) callbacks.Say(warning);
    }
    any_tracked = true;
    report.world = result.people[i].track.world.value_or(WorldFrame());
    person.track = TrackFile(request, person.number);
    WriteTrack(person.track, result.people[i].track);
    report.outputs.push_back(person.track);
  }
  if (request.overlay && any_tracked) {
    clock.Begin("overlay");
    WriteOverlay(request, scene, result, seen, callbacks, &report);
  }
  if (request.report && any_tracked) {
    clock.Begin("page");
    WriteReportPage(request, scene, result, callbacks, &report);
  }
  clock.End();
  report.seconds = clock.seconds();
  report.total_seconds = clock.total();
  report.peak_memory_bytes = PeakMemoryBytes();
  report.outputs.push_back(FileIn(request, "summary.json"));
  WriteFileAtomically(report.outputs.back(), ToJson(report));
  if (!any_tracked) {
    throw NothingToTrack(request.track.video + ": nobody could be tracked: " + report.people[0].solve.message);
  }
  return report;
}

}  // namespace bodyloom
