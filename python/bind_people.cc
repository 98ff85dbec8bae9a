// SPDX-License-Identifier: Apache-2.0
// Everybody in a video. docs/python.md.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "data_tools/motion/track_io.h"
#include "data_tools/observations/people.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "pipelines/detect/detect_people.h"
#include "pipelines/detect/upright_people.h"
#include "pipelines/files.h"
#include "pipelines/track/track_people_clip.h"
#include "pipelines/track/track_people_in_videos.h"
#include "python/bindings.h"
#include "python/keypoints_object.h"
#include "python/python_callbacks.h"
#include "python/track_object.h"

namespace bodyloom::python {
namespace {

constexpr const char* kRunDoc =
    R"(Everybody in a video, and nothing but the video needed (`bodyloom run`): a list of Tracks, the person who is
largest, best seen and longest in view first, all in one camera frame with one focal length and one ground. A track
begins with the first frame that shows the person and has the video's times; a person in whom nothing can be tracked
is left out.

video           a video, or a folder of images, of which fps tells the rate; a list of several of cameras that stood
                still and filmed the same people: the tracks are in the first one's frame and time, out is needed and
                gets rig.json too, camera may be a file of all, of which known says how much to use;
                same_lens: they are of one kind and not zoomed
out             folder that gets what the command writes: detections.npz, person_0.npz, ..., summary.json and, as
                asked for, overlay (a video, with side_view from the side too), masks (coarse_masks: as the network
                gives them), report (a page); None: no file
people, person  at most so many (0: everybody); only this one; min_seconds: whoever is seen for less is left out
detector        size of BlazePose's network: "lite", "full" or "heavy"; pose_model, box_model: networks of your own;
                models: folder of BlazePose's (`./dev models`); detect_rate: detect so many frames a second only while
                everybody moves slowly; mask: use people's masks; hands: "auto" finds hands and
                faces where they are large enough, "on" however small, "off" none: tracks of the built-in body have
                fingers then, if somebody shows a hand; None: "auto", but "off" with a body without fingers
rotate          turn the video clockwise by 90, 180 or 270 degrees, or "auto", so that people are upright;
                captured_fps: slow motion, frames a second at which it was filmed
camera, body    objects or files
rest            as of track()

Raises ValueError for arguments that contradict each other, RuntimeError for a file that cannot be used, and where
nobody is found or can be tracked, Cancelled, KeyboardInterrupt on Ctrl-C.)";

constexpr const char* kDetectDoc =
    R"(2D landmarks of everybody in a video (`bodyloom detect`): a list of Keypoints of all its frames, the person who is
largest, best seen and longest in view first; where a person is not seen, joints are missing. track() takes one.

Arguments as of run(). Raises RuntimeError for a file that cannot be used, ValueError, Cancelled; a video that shows
nobody gives an empty list. `hands`: "auto" finds hands and faces where they are large enough, "on" however small, "off"
none; whoever has any is a PersonKeypoints.)";

std::shared_ptr<TrackObject> ObjectOf(Track track, const std::string& name, const TrackSequenceSummary& summary,
                                      const std::shared_ptr<const BodyModel>& body) {
  auto object = std::make_shared<TrackObject>(std::move(track), name, body);
  object->summary = summary;
  return object;
}

std::vector<std::shared_ptr<TrackObject>> ReadTracks(const TrackPeopleReport& report,
                                                     const std::shared_ptr<const BodyModel>& body) {
  std::vector<std::shared_ptr<TrackObject>> tracks;
  for (const TrackedPerson& person : report.people) {
    if (!person.track.empty()) tracks.push_back(ObjectOf(ReadTrack(person.track), person.track, person.solve, body));
  }
  return tracks;
}

std::vector<std::shared_ptr<TrackObject>> RunPeople(const TrackPeopleClipRequest& request, GivenInMemory given,
                                                    const py::object& progress) {
  const std::shared_ptr<const BodyModel> body = BodyToKeep(request.track, &given);
  PythonCallbacks python(progress);
  std::vector<std::shared_ptr<TrackObject>> tracks;
  if (request.out.empty()) {
    TrackedPeople found =
        python.Run([&](const PipelineCallbacks& callbacks) { return TrackPeopleToMemory(request, callbacks, given); });
    for (size_t i = 0; i < found.people.size(); ++i) {
      if (!found.people[i].summary.IsUsable()) continue;
      const std::string name = Concatenate(request.track.video, ", person ", found.report.people[i].number);
      tracks.push_back(ObjectOf(std::move(found.people[i].track), name, found.people[i].summary, body));
    }
    return tracks;
  }
  const TrackPeopleReport report =
      python.Run([&](const PipelineCallbacks& callbacks) { return TrackPeopleClip(request, callbacks, given); });
  return ReadTracks(report, body);
}

std::vector<std::shared_ptr<TrackObject>> RunPeopleInVideos(const TrackPeopleInVideosRequest& request,
                                                            GivenInMemory given, const py::object& progress) {
  BODYLOOM_CHECK(!request.out.empty(),
                 "several videos: their tracks and cameras are written into a folder, expected out");
  BODYLOOM_CHECK(!given.camera, "camera: with several videos expected a file of all cameras");
  const std::shared_ptr<const BodyModel> body = BodyToKeep(request.track, &given);
  const TrackPeopleReport report = PythonCallbacks(progress).Run(
      [&](const PipelineCallbacks& callbacks) { return TrackPeopleInVideos(request, callbacks, given.body); });
  return ReadTracks(report, body);
}

py::list Detect(DetectPeopleRequest request, bool find_turn, const py::object& progress) {
  std::vector<PersonDetections> people = PythonCallbacks(progress).Run([&](const PipelineCallbacks& callbacks) {
    if (find_turn) request.span.turn_deg = FindTurn(request, callbacks);
    const DetectedClip clip = DetectPeople(request, callbacks);
    SayAdviceOnTurn(request.video, clip.people, callbacks);
    std::vector<PersonDetections> found;
    for (const PersonTrack& person : LinkPeople(clip.people)) {
      found.push_back({KeypointsOf(clip.people, person), HandsAndFaceOf(clip.people, person)});
    }
    return found;
  });
  py::list objects;
  for (PersonDetections& person : people) objects.append(KeypointsObject(std::move(person)));
  return objects;
}

}  // namespace

void BindPeople(py::module_& module) {
  module.def(
      "run",
      [](const std::variant<Path, std::vector<Path>>& video, const std::optional<Path>& out, int people,
         std::optional<int> person, double min_seconds, std::optional<double> fps, double min_confidence,
         const std::string& view, const std::string& known, bool same_lens, const std::optional<CameraArgument>& camera,
         std::optional<double> focal_px, std::optional<double> focal_35mm, bool still,
         const std::optional<Path>& camera_path_out, const std::optional<BodyArgument>& body,
         std::optional<double> stature_m, const std::optional<Path>& prior, const std::optional<Path>& lifter,
         const std::string& detector, const std::optional<Path>& pose_model, const std::optional<Path>& box_model,
         const std::optional<Path>& models, std::optional<double> detect_rate, bool mask, double begin_s,
         std::optional<double> end_s, const TurnArgument& rotate, std::optional<double> captured_fps,
         const std::optional<std::string>& hands, const std::string& solver, int threads, bool uncertainty, bool ground,
         bool overlay, bool side_view, bool masks, bool coarse_masks, bool report, const py::object& progress) {
        BODYLOOM_CHECK(people >= 0 && person.value_or(0) >= 0 && min_seconds >= 0,
                       "people, person, min_seconds: expected 0 or more");
        BODYLOOM_CHECK(out || !(side_view || masks || report),
                       "side_view, masks, report: are written into a folder, expected out");
        CheckThreads(threads);
        TrackPeopleInVideosRequest request;
        GivenInMemory given;
        request.out = TextOf(out);
        request.known = KnownOfRigFromString(known);
        request.same_lens = same_lens;
        request.max_people = people, request.person = person, request.min_seconds = min_seconds;
        request.overlay = overlay, request.report = report;
        request.masks = masks, request.coarse_masks = coarse_masks;
        TrackSettings& track = request.track;
        track.fps = PositiveOr0(fps, "fps");
        track.min_confidence = min_confidence;
        track.focal_px = PositiveOr0(focal_px, "focal_px");
        track.focal_35mm_mm = PositiveOr0(focal_35mm, "focal_35mm");
        track.find_camera_motion = !still;
        track.camera_path_out = TextOf(camera_path_out);
        track.stature_m = PositiveOr0(stature_m, "stature_m");
        track.prior = TextOf(prior), track.lifter = TextOf(lifter);
        track.detector = DetectorFrom(detector, pose_model, box_model, models);
        if (hands) track.detector.hands_and_faces = HandsAndFaceChoiceNamed(*hands);
        track.detect_rate = PositiveOr0(detect_rate, "detect_rate");
        track.use_mask = mask;
        track.from_s = begin_s, track.to_s = end_s.value_or(-1);
        track.turn_deg = TurnFrom(rotate), track.captured_fps = PositiveOr0(captured_fps, "captured_fps");
        request.side_view = side_view;
        track.solve.solver = SequenceSolverFromString(solver);
        track.solve.num_threads = threads;
        track.solve.estimate_uncertainty = uncertainty;
        if (!ground) track.solve.ground = GroundOptions::Off();
        TakeCamera(camera, &track, &given);
        TakeBody(body, &track, &given);
        if (const auto* videos = std::get_if<std::vector<Path>>(&video)) {
          for (const Path& one : *videos) request.videos.push_back(one.string());
        } else {
          request.videos = {std::get<Path>(video).string()};
        }
        if (HasSeveralVideos(request)) return RunPeopleInVideos(request, std::move(given), progress);
        if (!view.empty()) request.views = {view};
        return RunPeople(RequestOfOneVideo(request), std::move(given), progress);
      },
      py::arg("video"), py::kw_only(), py::arg("out") = py::none(), py::arg("people") = 0,
      py::arg("person") = py::none(), py::arg("min_seconds") = 0.5, py::arg("fps") = py::none(),
      py::arg("min_confidence") = 0.0, py::arg("view") = "", py::arg("known") = ToString(KnownOfRig::kClocks),
      py::arg("same_lens") = false, py::arg("camera") = py::none(), py::arg("focal_px") = py::none(),
      py::arg("focal_35mm") = py::none(), py::arg("still") = false, py::arg("camera_path_out") = py::none(),
      py::arg("body") = py::none(), py::arg("stature_m") = py::none(), py::arg("prior") = py::none(),
      py::arg("lifter") = py::none(), py::arg("detector") = "heavy", py::arg("pose_model") = py::none(),
      py::arg("box_model") = py::none(), py::arg("models") = py::none(), py::arg("detect_rate") = py::none(),
      py::arg("mask") = true, py::arg("begin_s") = 0.0, py::arg("end_s") = py::none(), py::arg("rotate") = 0,
      py::arg("captured_fps") = py::none(), py::arg("hands") = py::none(),
      py::arg("solver") = ToString(TrackSequenceOptions().solver), py::arg("threads") = 0,
      py::arg("uncertainty") = true, py::arg("ground") = true, py::arg("overlay") = true, py::arg("side_view") = false,
      py::arg("masks") = false, py::arg("coarse_masks") = false, py::arg("report") = false,
      py::arg("progress") = py::none(), kRunDoc);
  module.def(
      "detect",
      [](const Path& video, std::optional<double> fps, const std::string& detector,
         const std::optional<Path>& pose_model, const std::optional<Path>& box_model, const std::optional<Path>& models,
         const std::string& hands, int people, std::optional<double> detect_rate, double begin_s,
         std::optional<double> end_s, const TurnArgument& rotate, std::optional<double> captured_fps, int threads,
         const py::object& progress) {
        BODYLOOM_CHECK(people >= 0, "people: expected 0 or more, found ", people);
        CheckThreads(threads);
        DetectPeopleRequest request;
        request.video = video.string();
        const std::optional<int> turn_deg = TurnFrom(rotate);
        request.span = {PositiveOr0(fps, "fps"), begin_s, end_s.value_or(-1), turn_deg.value_or(0),
                        PositiveOr0(captured_fps, "captured_fps")};
        request.detector = DetectorFrom(detector, pose_model, box_model, models);
        request.detector.hands_and_faces = HandsAndFaceChoiceNamed(hands);
        request.detector.blazepose.max_people = people;
        request.detector.blazepose.num_threads = ThreadsFor(threads);
        request.detect_rate = PositiveOr0(detect_rate, "detect_rate");
        RequireReadable(request.video, "video");
        RequirePoseModels(request.detector);
        return Detect(request, !turn_deg, progress);
      },
      py::arg("video"), py::kw_only(), py::arg("fps") = py::none(), py::arg("detector") = "heavy",
      py::arg("pose_model") = py::none(), py::arg("box_model") = py::none(), py::arg("models") = py::none(),
      py::arg("hands") = "auto", py::arg("people") = 0, py::arg("detect_rate") = py::none(), py::arg("begin_s") = 0.0,
      py::arg("end_s") = py::none(), py::arg("rotate") = 0, py::arg("captured_fps") = py::none(),
      py::arg("threads") = 0, py::arg("progress") = py::none(), kDetectDoc);
}

}  // namespace bodyloom::python
