// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/track_people_clip.h"

#include <filesystem>
#include <utility>
#include <vector>

#include "data_tools/observations/part_labels.h"
#include "data_tools/observations/people_npz.h"
#include "geometry/base/check.h"
#include "pipelines/detect/cut_masks.h"
#include "pipelines/files.h"
#include "pipelines/page/write_clip_page.h"
#include "pipelines/track/found_camera_motion.h"
#include "pipelines/track/overlay_video.h"
#include "pipelines/track/people_outputs.h"
#include "pipelines/track/track_inputs.h"

namespace bodyloom {
namespace {

std::string FileIn(const TrackPeopleClipRequest& request, const std::string& name) {
  return (std::filesystem::path(request.out) / name).string();
}

std::string MaskFile(const TrackPeopleClipRequest& request, int number) {
  return FileIn(request, Concatenate("mask_", number, ".npz"));
}

/// The settings of every person's track, under the names that what is given has in messages.
TrackSettings NamedSettings(const TrackPeopleRequest& request, const GivenInMemory& given) {
  TrackSettings track = request.track;
  if (given.camera) track.cameras = "camera";
  return track;
}

void CheckRequest(const TrackPeopleRequest& request, const GivenInMemory& given) {
  CheckTrackPeopleRequest(request);
  CheckTrackSettings(NamedSettings(request, given));
}

void CheckFiles(const TrackPeopleClipRequest& request) {
  RequireDistinct(
      RequireFiles(request.track, request.track.detector),
      {FileIn(request, "detections.npz"), TrackFileIn(request.out, 0), request.masks ? MaskFile(request, 0) : "",
       request.overlay ? FileIn(request, "overlay.mp4") : "", request.report ? FileIn(request, "report.html") : "",
       FileIn(request, "summary.json"), request.track.camera_path_out});
  RequireWritableFolder(request.out);
}

void CheckClipRequest(const TrackPeopleClipRequest& request, const GivenInMemory& given) {
  if (request.out.empty()) throw RequestError("--out is required: the folder for the results");
  if (request.masks && !request.track.use_mask) {
    throw RequestError("--masks writes what --no-mask leaves out, expected one of them");
  }
  if (request.masks && !request.track.detector.pose_model.empty()) {
    throw RequestError("--masks are BlazePose's: leave them out with --pose-model");
  }
  if (request.side_view && !request.overlay) {
    throw RequestError("--side-view is a part of the overlay: give --overlay");
  }
  CheckRequest(request, given);
  CheckFiles(request);
}

void WriteMasks(const TrackPeopleClipRequest& request, const ChosenPeople& people, const PipelineCallbacks& callbacks,
                TrackPeopleReport* report) {
  DetectedClip clip = people.clip;
  report->masks_cut =
      !request.coarse_masks && CutMasks(DetectionOf(request.track), request.track.solve.num_threads, &clip, callbacks);
  for (const int number : people.chosen) {
    report->outputs.push_back(MaskFile(request, number));
    WriteMask(report->outputs.back(), MaskOfPerson(clip, people.everybody[size_t(number)]));
  }
}

SceneInputs SceneOf(const TrackPeopleRequest& request, const GivenInMemory& given) {
  const TrackSettings named = NamedSettings(request, given);
  SceneInputs scene = LoadSceneInputs(named, given);
  UseFocal(named, &scene.camera.camera);
  return scene;
}

void FindMotion(const TrackPeopleRequest& request, const ChosenPeople& people, const PipelineCallbacks& callbacks,
                StageClock* clock, SceneInputs* scene, TrackPeopleReport* report) {
  if (!WhyNoCameraMotion(request.track).empty()) return;
  clock->Begin("camera");
  UseCameraMotion(request.track, people.clip.background, callbacks, scene, &report->camera_path);
}

void WriteOverlay(const TrackPeopleClipRequest& request, const SceneInputs& scene, const TrackedScene& tracked,
                  const PipelineCallbacks& callbacks, TrackPeopleReport* report) {
  PeopleOverlayVideo overlay;
  for (size_t i = 0; i < tracked.seen.size(); ++i) {
    if (report->people[i].track.empty()) continue;
    overlay.people.push_back({.body = tracked.bodies[i],
                              .track = &tracked.result.people[i].track,
                              .detected = &tracked.seen[i].keypoints,
                              .hands_and_face = &tracked.seen[i].hands_and_face,
                              .number = report->people[i].number});
  }
  overlay.video = request.track.video;
  overlay.video_px_from_camera_px = scene.camera.video_px_from_camera_px;
  overlay.side_view = request.side_view;
  SetScene(tracked.result.summary.scene, CameraPose(), &overlay);
  callbacks.Begin("drawing the overlay");
  overlay.progress = [&](double fraction) { callbacks.Update("overlay", fraction); };
  const std::string path = FileIn(request, "overlay.mp4");
  WritePeopleOverlayVideo(path, overlay);
  report->outputs.push_back(path);
}

void WriteReportPage(const TrackPeopleClipRequest& request, const SceneInputs& scene, const TrackedScene& tracked,
                     const PipelineCallbacks& callbacks, TrackPeopleReport* report) {
  ClipPageRequest page;
  page.out = FileIn(request, "report.html");
  page.people = PeopleOnPage(*report, tracked.bodies, tracked.result.people);
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

}  // namespace

TrackPeopleReport TrackPeopleClip(const TrackPeopleClipRequest& given_request, const PipelineCallbacks& callbacks,
                                  const GivenInMemory& given) {
  CheckClipRequest(given_request, given);
  StageClock clock;
  clock.Begin("read");
  TrackPeopleClipRequest request = given_request;
  request.track = WithTurn(request.track, callbacks);
  request.track.all_masks = request.masks;
  SceneInputs scene = SceneOf(request, given);
  request.track.detector.hands_and_faces = HandsFor(request, given, *scene.body);
  clock.Begin("detect");
  ChosenPeople people = DetectAndChoosePeople(request, callbacks);
  TrackPeopleReport report = ReportOf(request, people);
  FindMotion(request, people, callbacks, &clock, &scene, &report);
  clock.Begin("write");
  report.outputs.push_back(FileIn(request, "detections.npz"));
  WritePeople(report.outputs.back(), people.clip.people);
  if (request.masks) {
    clock.Begin("masks");
    WriteMasks(request, people, callbacks, &report);
  }
  clock.Begin("track");
  const TrackedScene tracked =
      TrackDetectedPeople(request, scene, &people, GivesFingers(request, given), callbacks, &report);
  clock.Begin("write");
  WriteTracks(request.out, tracked.result.people, &report);
  if (request.overlay && tracked.any) {
    clock.Begin("overlay");
    WriteOverlay(request, scene, tracked, callbacks, &report);
  }
  if (request.report && tracked.any) {
    clock.Begin("page");
    WriteReportPage(request, scene, tracked, callbacks, &report);
  }
  WriteSummary(request.out, &clock, &report);
  RequireAnyTrack(request, tracked);
  return report;
}

TrackedPeople TrackPeopleToMemory(const TrackPeopleRequest& given_request, const PipelineCallbacks& callbacks,
                                  const GivenInMemory& given) {
  CheckRequest(given_request, given);
  RequireFiles(given_request.track, given_request.track.detector);
  StageClock clock;
  clock.Begin("read");
  TrackPeopleRequest request = given_request;
  request.track = WithTurn(request.track, callbacks);
  SceneInputs scene = SceneOf(request, given);
  request.track.detector.hands_and_faces = HandsFor(request, given, *scene.body);
  clock.Begin("detect");
  ChosenPeople people = DetectAndChoosePeople(request, callbacks);
  TrackedPeople found;
  found.report = ReportOf(request, people);
  FindMotion(request, people, callbacks, &clock, &scene, &found.report);
  clock.Begin("track");
  TrackedScene tracked =
      TrackDetectedPeople(request, scene, &people, GivesFingers(request, given), callbacks, &found.report);
  RequireAnyTrack(request, tracked);
  EndReport(&clock, &found.report);
  found.people = std::move(tracked.result.people);
  return found;
}

}  // namespace bodyloom
