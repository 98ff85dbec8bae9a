// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/track_people_in_videos.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <utility>

#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/observations/people_npz.h"
#include "data_tools/observations/rig_io.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/scene/rig.h"
#include "pipelines/files.h"
#include "pipelines/page/write_clip_page.h"
#include "pipelines/track/detected_people.h"
#include "pipelines/track/overlay_video.h"
#include "pipelines/track/people_outputs.h"
#include "pipelines/track/picture_lines.h"
#include "pipelines/track/track_inputs.h"
#include "pipelines/track/view_hands.h"
#include "pipelines/video/track_video.h"
#include "tracking/hands/fit_hands.h"
#include "tracking/hands/hands_in_views.h"
#include "tracking/initialise/swap_repair.h"
#include "tracking/rig/track_people_in_views.h"

namespace bodyloom {
namespace {

/// One camera's video and those who were found in it.
struct VideoOfView {
  std::string name, video, nobody;  ///< `nobody`: the reason why nobody was found
  TrackPeopleRequest request;
  SceneInputs scene;
  ChosenPeople people;
  PictureVertical lines;
  std::vector<KeypointSequence> seen;                ///< of the chosen people, with times of the video's own clock
  std::vector<HandsAndFaceSequence> hands_and_face;  ///< of the same people and frames
  std::optional<CameraPose> camera_from_rig;
  RigCamera clock;  ///< where it is known
};

std::string FileInFolder(const TrackPeopleInVideosRequest& request, const std::string& name) {
  return (std::filesystem::path(request.out) / name).string();
}

TrackPeopleRequest RequestOfVideo(const TrackPeopleInVideosRequest& request, size_t v) {
  TrackPeopleRequest one = request;
  one.track.video = request.videos[v];
  one.track.view = "";
  one.track.use_mask = false;  // which several views do not use
  one.track.find_camera_motion = false;
  if (v == 0) return one;
  one.max_people = 0;
  one.person.reset();
  one.track.from_s = 0;
  one.track.to_s = -1;
  return one;
}

void RefuseUnused(const TrackPeopleInVideosRequest& request) {
  const TrackSettings& track = request.track;
  const std::vector<std::pair<bool, const char*>> unused = {{!track.camera_path.empty(), "--camera-path"},
                                                            {!track.camera_path_out.empty(), "--camera-path-out"},
                                                            {request.masks, "--masks"},
                                                            {track.camera == "weak", "--camera weak"}};
  for (const auto& [given, option] : unused) {
    if (given) {
      throw RequestError(
          Concatenate("several videos are tracked by 2D joints of cameras that stand still: leave out ", option));
    }
  }
  if (request.known != KnownOfRig::kClocks && track.cameras.empty()) {
    throw RequestError("--known says how much of --cameras to use: give --cameras FILE");
  }
}

void CheckNames(const TrackPeopleInVideosRequest& request) {
  if (!request.views.empty() && request.views.size() != request.videos.size()) {
    throw RequestError(Concatenate(request.videos.size(), " videos and ", request.views.size(),
                                   " names in --view, expected a name for each video"));
  }
  std::set<std::string> videos, names;
  for (const std::string& video : request.videos) {
    if (!videos.insert(video).second) throw RequestError(video + " is given twice, expected a video of each camera");
  }
  for (const std::string& name : request.views) {
    if (name.empty() || name.find('/') != std::string::npos) {
      throw RequestError("--view '" + name + "': expected a name without '/'");
    }
    if (!names.insert(name).second) throw RequestError("--view lists " + name + " twice");
  }
}

void CheckVideosRequest(const TrackPeopleInVideosRequest& request, const std::vector<std::string>& names) {
  if (request.out.empty()) throw RequestError("--out is required: the folder for the results");
  RefuseUnused(request);
  CheckNames(request);
  if (request.side_view && !request.overlay) {
    throw RequestError("--side-view is a part of the overlay: leave out --no-overlay");
  }
  std::vector<std::string> inputs,
      outputs = {FileInFolder(request, "person_0.npz"), FileInFolder(request, "rig.json"),
                 FileInFolder(request, "summary.json"), request.report ? FileInFolder(request, "report.html") : ""};
  for (size_t v = 0; v < names.size(); ++v) {
    TrackPeopleRequest one = RequestOfVideo(request, v);
    CheckTrackPeopleRequest(one);
    CheckTrackSettings(one.track);
    for (const std::string& file : RequireFiles(one.track, one.track.detector)) inputs.push_back(file);
    outputs.push_back(FileInFolder(request, "detections_" + names[v] + ".npz"));
    if (request.overlay) outputs.push_back(FileInFolder(request, "overlay_" + names[v] + ".mp4"));
  }
  RequireDistinct(inputs, outputs);
  RequireWritableFolder(request.out);
}

/// Reads the views' cameras and models.
std::vector<VideoOfView> LoadVideos(const TrackPeopleInVideosRequest& request, const std::vector<std::string>& names,
                                    const std::shared_ptr<const BodyModel>& body, const PipelineCallbacks& callbacks) {
  const KnownRig rig({.cameras = request.track.cameras,
                      .detections = request.videos[0],
                      .names_given = !request.views.empty(),
                      .known = request.known},
                     names);
  std::vector<VideoOfView> videos;
  for (size_t v = 0; v < names.size(); ++v) {
    const NamedCamera* camera = rig.CameraOf(v);
    GivenInMemory given;
    given.body = v > 0 ? videos[0].scene.body : body;
    if (camera != nullptr) given.camera = camera->camera;
    VideoOfView& view = videos.emplace_back();
    view.name = names[v];
    view.request = RequestOfVideo(request, v);
    view.request.track = WithTurn(view.request.track, callbacks);
    view.video = view.request.track.video;
    view.scene = LoadSceneInputs(view.request.track, given);
    UseFocal(view.request.track, &view.scene.camera.camera);
    if (camera != nullptr) view.scene.camera.video_px_from_camera_px = camera->video_px_from_camera_px;
    view.camera_from_rig = rig.PoseOf(v);
    // About the middle of the first video, which is not known before it is read: the clocks are linear.
    view.clock = rig.ClockOf(v, 0);
  }
  return videos;
}

/// Detects everybody. Throws NoPersonFound if the first video shows nobody.
void DetectInVideos(const TrackPeopleInVideosRequest& request, const PipelineCallbacks& callbacks,
                    std::vector<VideoOfView>* videos, std::vector<std::string>* outputs) {
  for (VideoOfView& view : *videos) {
    try {
      view.people = DetectAndChoosePeople(view.request, callbacks);
    } catch (const NoPersonFound& nobody) {
      if (&view == &videos->front()) throw;
      view.nobody = nobody.what();
      continue;
    }
    for (const int number : view.people.chosen) {
      const PersonTrack& person = view.people.everybody[static_cast<size_t>(number)];
      DetectedObservations observed =
          ObservationsOf(view.people.clip, person, SpanOf(person), view.request.track, view.scene);
      KeypointSequence& seen = view.seen.emplace_back(std::move(observed.keypoints));
      view.hands_and_face.push_back(std::move(observed.hands_and_face));
      if (!view.clock.HasClock()) continue;
      for (double& time : seen.timestamps) time = view.clock.FirstTimeAt(time);
    }
    view.lines = VerticalOfClip(view.request.track, view.people.clip, view.scene);
    outputs->push_back(FileInFolder(request, "detections_" + view.name + ".npz"));
    WritePeople(outputs->back(), view.people.clip.people);
  }
}

std::vector<ObservedScene> ScenesOf(const TrackPeopleInVideosRequest& request, const std::vector<VideoOfView>& videos) {
  std::vector<ObservedScene> scenes;
  for (const VideoOfView& view : videos) {
    TrackSequenceInput input = view.scene.ForTracker();
    UsePictureVertical(view.lines, view.scene.camera_knowledge, &input);
    ObservedScene& scene = scenes.emplace_back();
    for (const KeypointSequence& person : view.seen) scene.people.push_back(&person);
    scene.camera.knowledge = view.scene.camera_knowledge;
    scene.camera.camera = input.camera;
    scene.camera.focal_prior = input.focal_prior;
    if (request.same_lens) scene.camera.focal_ratio_log_sigma = kSameLensLogSigma;
    scene.camera.picture_vertical = input.picture_vertical;
    scene.camera.camera_from_rig = view.camera_from_rig;
    if (view.clock.HasClock()) scene.camera.offset_s = 0;  // the times are of the first video's clock
  }
  return scenes;
}

TrackPeopleInViewsResult Solve(const TrackPeopleInVideosRequest& request, const std::vector<VideoOfView>& videos,
                               const PipelineCallbacks& callbacks) {
  TrackSequenceOptions options = request.track.solve;
  options.straight_knees_weight = StraightKneesWeight(request.track, videos[0].seen[0].convention);
  bool cancelled = false;
  options.progress = [&](const TrackProgress& at) {
    cancelled = !callbacks.ReportProgress(at.stage, at.fraction);
    return !cancelled;
  };
  const size_t count = videos[0].seen.size();
  callbacks.Begin(
      Concatenate("tracking ", count, count == 1 ? " person in " : " people in ", videos.size(), " videos"));
  TrackPeopleInViewsResult result =
      TrackPeopleInViews(ScenesOf(request, videos), videos[0].scene.ForTracker(), options);
  if (cancelled) throw Cancelled();
  for (TrackSequenceResult& person : result.people) person.track.playback = videos[0].scene.playback;
  return result;
}

/// The cameras by the leader's fit.
std::vector<ViewReport> ReportsOf(const std::vector<VideoOfView>& videos, const TrackPeopleInViewsResult& result) {
  const TrackSequenceResult& leader = result.people[static_cast<size_t>(result.leader)];
  const std::vector<double>& times = leader.track.motion.timestamps;
  const double middle_s = 0.5 * (times.front() + times.back());
  std::vector<ViewReport> reports = {ReportOnFirstView(leader.summary, leader.track.camera, middle_s)};
  reports[0].frames = leader.track.num_frames();
  reports[0].camera.focal_log_sigma = result.scene.focal_log_sigma;
  for (size_t v = 1; v < videos.size(); ++v) {
    if (result.left_out[v].empty()) {
      reports.push_back(ReportOnView(result.cameras[v - 1], videos[v].clock, middle_s));
      reports.back().doubt = DoubtAbout(reports.back(), reports[0]);
    } else {
      reports.emplace_back().left_out = videos[v].nobody.empty() ? result.left_out[v] : videos[v].nobody;
    }
  }
  for (size_t v = 0; v < videos.size(); ++v) {
    reports[v].camera.name = videos[v].name;
    reports[v].video = videos[v].video;
    if (videos[v].nobody.empty()) reports[v].fps = VideoFrameRate(videos[v].people.clip.people.timestamps);
  }
  return reports;
}

/// Hands and heads of everybody, by the views that show them; their tracks are put onto a body with fingers then if
/// `gives_fingers`. Returns the bodies of all tracks.
std::vector<const BodyModel*> FitHandsOfAll(const TrackPeopleInVideosRequest& request,
                                            const std::vector<VideoOfView>& videos,
                                            const std::vector<ViewReport>& reports, bool gives_fingers,
                                            TrackPeopleInViewsResult* result) {
  std::vector<const BodyModel*> bodies(result->people.size(), videos[0].scene.body.get());
  for (size_t i = 0; i < result->people.size(); ++i) {
    TrackSequenceResult& person = result->people[i];
    if (!person.summary.IsUsable()) continue;
    const std::vector<double>& times = person.track.motion.timestamps;
    std::vector<HandsOfView> views;
    for (size_t v = 0; v < videos.size(); ++v) {
      const int number = result->person_in_view[i][v];
      if (number < 0 || !reports[v].left_out.empty()) {
        views.emplace_back();
        continue;
      }
      const auto seen = static_cast<size_t>(number);
      views.push_back(HandsOfViewAt(reports[v].camera, videos[v].hands_and_face[seen], videos[v].seen[seen].timestamps,
                                    v == 0 || videos[v].clock.HasClock(), times, reports[v].fps));
    }
    const bool shows_hand =
        std::any_of(views.begin(), views.end(), [](const HandsOfView& view) { return ShowsHand(view.seen); });
    if (gives_fingers && shows_hand) {
      bodies[i] = &BuiltinBodyWithHands();
      GiveFingers(*bodies[i], &person.track);
    }
    if (std::all_of(views.begin(), views.end(), [](const HandsOfView& view) { return view.seen.empty(); })) continue;
    FitHandsInViews(*bodies[i], views, FindCuts(videos[0].seen[i]), ThreadsFor(request.track.solve.num_threads),
                    &person);
  }
  return bodies;
}

/// The detections at these times of the same clock.
KeypointSequence KeypointsAt(const KeypointSequence& keypoints, const std::vector<double>& times, double fps) {
  KeypointSequence nearest = keypoints;
  nearest.timestamps = times;
  nearest.points.assign(times.size() * static_cast<size_t>(keypoints.num_points()), Keypoint());
  const std::vector<int> frames = NearestFrames(keypoints.timestamps, times, fps);
  for (size_t t = 0; t < times.size(); ++t) {
    if (frames[t] < 0) continue;
    const auto first = keypoints.points.begin() + static_cast<ptrdiff_t>(frames[t]) * keypoints.num_points();
    std::copy(first, first + keypoints.num_points(),
              nearest.points.begin() + static_cast<ptrdiff_t>(t) * keypoints.num_points());
  }
  return nearest;
}

void WriteOverlayOfView(const TrackPeopleInVideosRequest& request, const VideoOfView& view, size_t v,
                        const TrackPeopleInViewsResult& result, const std::vector<const BodyModel*>& bodies,
                        const PipelineCallbacks& callbacks, TrackPeopleReport* report) {
  const RigCamera& camera = report->views[v].camera;
  const size_t count = result.people.size();
  std::vector<Track> tracks(count);
  std::vector<KeypointSequence> detected(count);
  PeopleOverlayVideo overlay;
  for (size_t i = 0; i < count; ++i) {
    if (report->people[i].track.empty()) continue;
    tracks[i] = TrackSeenBy(camera, *bodies[i], result.people[i].track);
    tracks[i].playback = view.scene.playback;
    PersonInOverlay& person = overlay.people.emplace_back();
    person.body = bodies[i];
    person.track = &tracks[i];
    person.number = report->people[i].number;
    if (const int seen = result.person_in_view[i][v]; seen >= 0) {
      KeypointSequence own = view.seen[static_cast<size_t>(seen)];
      if (view.clock.HasClock()) {
        for (double& time : own.timestamps) time = view.clock.TimeAt(time);
      }
      detected[i] = KeypointsAt(own, tracks[i].motion.timestamps, report->views[v].fps);
      person.detected = &detected[i];
    }
  }
  overlay.video = view.video;
  overlay.video_px_from_camera_px = view.scene.camera.video_px_from_camera_px;
  overlay.side_view = request.side_view;
  SetScene(result.scene, camera.camera_from_rig, &overlay);
  callbacks.Begin("drawing the overlay of " + view.name);
  overlay.progress = [&](double fraction) { callbacks.Update("overlay", fraction); };
  report->outputs.push_back(FileInFolder(request, "overlay_" + view.name + ".mp4"));
  WritePeopleOverlayVideo(report->outputs.back(), overlay);
}

void WritePageOfViews(const TrackPeopleInVideosRequest& request, const std::vector<VideoOfView>& videos,
                      const TrackPeopleInViewsResult& result, const std::vector<const BodyModel*>& bodies,
                      const PipelineCallbacks& callbacks, TrackPeopleReport* report) {
  ClipPageRequest page;
  page.out = FileInFolder(request, "report.html");
  page.people = PeopleOnPage(*report, bodies, result.people);
  page.video = videos[0].video;
  page.video_px_from_camera_px = videos[0].scene.camera.video_px_from_camera_px;
  page.view_name = videos[0].name;
  for (size_t v = 1; v < videos.size(); ++v) {
    const ViewReport& view = report->views[v];
    if (!view.left_out.empty()) continue;
    const SceneInputs& scene = videos[v].scene;
    page.views.push_back({view.camera, view.video, scene.camera.video_px_from_camera_px, scene.playback});
  }
  page.title =
      std::filesystem::path(page.video).filename().string() + " and " + std::to_string(page.views.size()) + " more";
  TrackPeopleReport told = *report;
  told.outputs.clear();  // files are where the page is
  page.summary = ToText(told);
  callbacks.Begin("writing the page");
  WriteClipPage(page, callbacks);
  report->outputs.push_back(page.out);
}

/// Adds the results of the fits to the report.
void AddResults(const TrackPeopleInVideosRequest& request, const std::vector<VideoOfView>& videos,
                const TrackPeopleInViewsResult& result, const std::vector<const BodyModel*>& bodies,
                TrackPeopleReport* report) {
  report->scene = result.scene;
  for (size_t i = 0; i < result.people.size(); ++i) {
    TrackedPerson& person = report->people[i];
    person.solve = result.people[i].summary;
    for (size_t v = 0; v < videos.size(); ++v) {
      if (result.person_in_view[i][v] >= 0 && result.left_out[v].empty()) person.views.push_back(videos[v].name);
    }
    if (!person.solve.IsUsable()) continue;
    const Track& track = result.people[i].track;
    report->world = track.world.value_or(WorldFrame());
    person.room = RoomPhysicsOnGround(track, *bodies[i], ThreadsFor(request.track.solve.num_threads));
  }
}

}  // namespace

bool HasSeveralVideos(const TrackPeopleInVideosRequest& request) { return request.videos.size() > 1; }

TrackPeopleClipRequest RequestOfOneVideo(const TrackPeopleInVideosRequest& request) {
  if (request.views.size() > 1) throw RequestError("--view names several cameras: give a video of each");
  if (request.known != KnownOfRig::kClocks) throw RequestError("--known is of several cameras: give a video of each");
  if (request.same_lens) throw RequestError("--same-lens is of several cameras: give a video of each");
  TrackPeopleClipRequest one = request;
  if (!request.videos.empty()) one.track.video = request.videos[0];
  if (!request.views.empty()) one.track.view = request.views[0];
  return one;
}

TrackPeopleReport TrackPeopleInVideos(const TrackPeopleInVideosRequest& request, const PipelineCallbacks& callbacks,
                                      const std::shared_ptr<const BodyModel>& body) {
  if (!HasSeveralVideos(request)) throw RequestError("one video, expected several");
  const std::vector<std::string> names = NamesOfViews(request.views, request.videos);
  CheckVideosRequest(request, names);
  StageClock clock;
  clock.Begin("read");
  std::vector<VideoOfView> videos = LoadVideos(request, names, body, callbacks);
  GivenInMemory given;
  given.body = body;
  for (VideoOfView& view : videos) {
    view.request.track.detector.hands_and_faces = HandsFor(request, given, *view.scene.body);
  }
  clock.Begin("detect");
  std::vector<std::string> outputs;
  DetectInVideos(request, callbacks, &videos, &outputs);
  TrackPeopleReport report = ReportOf(videos[0].request, videos[0].people);
  report.outputs = std::move(outputs);
  clock.Begin("track");
  TrackPeopleInViewsResult result = Solve(request, videos, callbacks);
  if (result.leader < 0) {
    throw NoPersonFound(videos[1].video + " does not show the motion of anybody in " + videos[0].video + ": " +
                        (videos[1].nobody.empty() ? result.left_out[1] : videos[1].nobody));
  }
  report.views = ReportsOf(videos, result);
  const std::vector<const BodyModel*> bodies =
      FitHandsOfAll(request, videos, report.views, GivesFingers(request, given), &result);
  AddResults(request, videos, result, bodies, &report);
  clock.Begin("write");
  WarnAboutViews(report.views, "other people", callbacks);
  WriteTracks(request.out, result.people, &report);
  report.outputs.push_back(FileInFolder(request, "rig.json"));
  WriteRig(report.outputs.back(), RigOf(report.views));
  for (size_t v = 0; request.overlay && v < videos.size(); ++v) {
    if (!report.views[v].left_out.empty()) continue;
    clock.Begin("overlay");
    WriteOverlayOfView(request, videos[v], v, result, bodies, callbacks, &report);
  }
  if (request.report) {
    clock.Begin("page");
    WritePageOfViews(request, videos, result, bodies, callbacks, &report);
  }
  WriteSummary(request.out, &clock, &report);
  return report;
}

}  // namespace bodyloom
