// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

#include "data_tools/body/builtin_body.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/base/check.h"
#include "pipelines/track/solve_track.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/keypoints_object.h"
#include "python/python_callbacks.h"
#include "python/track_object.h"

namespace bodyloom::python {
namespace {

constexpr const char* kTrackFunctionDoc = R"(Fits one body to a clip: a pose in every frame, one shape, the camera.

What was seen
  keypoints       Keypoints, or the file or folder of a detector; of a file, `view`, `person`, `fps` and `convention`
                  say what Keypoints.load() is told
  dense           file or folder of dense surface keypoints; dense_uv_sigma: their noise in chart units
  part_labels     .npz with the DensePose part of every pixel
  video           for image size and frame rate; alone, people are detected in it (detector, pose_model, box_model,
                  models, detect_rate, mask); everybody at once: run()
  begin_s, end_s  seconds of the video, or of the keypoints
  rotate          turn the video clockwise by 90, 180 or 270 degrees, or "auto", so that people are upright
  captured_fps    slow motion: frames a second at which the video was filmed
  hands           "auto", "on": hands and face of the keypoints, or found in the video (however small: "on"), bend the
                  fingers of a body that has them and turn the head; "off": they do not; None: "auto" for a body with
                  fingers, else "off"
The camera
  camera          Camera, or a calibration file of which `view` names the camera
  focal_px        of a centred camera without distortion, pixels
  focal_35mm      of the lens for film of 36 mm x 24 mm, near which a focal length is estimated; None: what the video
                  or photo notes
  camera_model    "pinhole", "unknown-focal" (the focal length is estimated) or "weak"; None: pinhole where the camera
                  or focal_px is given, else unknown-focal
  image_size      (width, height), when nothing else gives it
  still           the camera stands still: its motion is not looked for in the video
  camera_path_out file for the path that is found in the video, JSON or COLMAP's images.txt
What else is known
  body            Body, or a file; None: the built-in one; "hands": that with fingers
  stature_m       of the person; from it distances follow
  init            poses of another system to start from and to stay near by init_weight
  prior, lifter   files of weights, or "none"; None: built in
The solve
  live_lag        frames: track as if the clip came from a camera (LiveTracker)
  solver          "chain+ceres" (Ceres from where chain ends), "chain" or "ceres"; threads 0: one a core; the track is
                  the same for any number
  max_iterations, estimate_shape, uncertainty, ground, skip_unneeded, rendered_weight, velocity_weight, straight_knees
                  as the options of `bodyloom track`
  progress        called as progress(stage, fraction) now and then; False ends the work with Cancelled

Returns a Track in the camera frame, metres; its summary says how it went. With the same options it is what `bodyloom
track` writes, to the byte. Raises ValueError for arguments that contradict each other, RuntimeError for a file that
cannot be used and for a clip in which nothing could be tracked, KeyboardInterrupt on Ctrl-C.)";

constexpr const char* kSyntheticClipDoc = R"(A clip with known truth, made on the spot: (keypoints, truth).

The built-in body walks, turns, waves and kicks for `frames` frames at `fps`, seen by a camera of `image_size` pixels;
its 2D joints carry a detector's noise and gaps. The same arguments give the same bytes.)";

using KeypointsArgument = std::variant<std::shared_ptr<PersonKeypoints>, std::shared_ptr<KeypointSequence>, Path>;

/// Request and inputs made of the Python arguments.
struct TrackArguments {
  TrackRequest request;
  GivenInMemory given;
  std::optional<PersonKeypoints> keypoints;
  std::string name;
};

void TakeKeypoints(const std::optional<KeypointsArgument>& argument, TrackArguments* arguments) {
  if (!argument) return;
  TrackRequest& request = arguments->request;
  if (const auto* path = std::get_if<Path>(&*argument)) {
    request.detections = path->string();
    return;
  }
  BODYLOOM_CHECK(request.view.empty() || !request.cameras.empty(),
                 "view: names a camera of files, found keypoints in memory");
  BODYLOOM_CHECK(request.person == 0 && request.fps == 0 && request.convention.empty(),
                 "person, fps and convention are of a file of detections, found keypoints in memory");
  PersonKeypoints& person = arguments->keypoints.emplace();
  if (const auto* with_hands = std::get_if<std::shared_ptr<PersonKeypoints>>(&*argument)) {
    person = **with_hands;
  } else {
    static_cast<KeypointSequence&>(person) = *std::get<std::shared_ptr<KeypointSequence>>(*argument);
  }
}

std::shared_ptr<TrackObject> RunTrack(TrackArguments arguments, const py::object& progress) {
  if (arguments.keypoints) {
    arguments.given.keypoints = &*arguments.keypoints;
    arguments.given.hands_and_face = &arguments.keypoints->hands_and_face;
  }
  const TrackRequest& request = arguments.request;
  CheckThreads(request.solve.num_threads);
  const std::shared_ptr<const BodyModel> body = BodyToKeep(request, &arguments.given);
  TrackSequenceResult result = PythonCallbacks(progress).Run(
      [&](const PipelineCallbacks& callbacks) { return TrackToMemory(arguments.request, arguments.given, callbacks); });
  if (!result.summary.IsUsable()) {
    throw std::runtime_error(arguments.name + ": nothing could be tracked: " + result.summary.message);
  }
  auto track = std::make_shared<TrackObject>(std::move(result.track), arguments.name, body);
  track->summary = std::move(result.summary);
  return track;
}

std::string NameOf(const TrackRequest& request) {
  for (const std::string* path : {&request.detections, &request.dense, &request.part_labels, &request.video}) {
    if (!path->empty()) return *path;
  }
  return "keypoints";
}

std::pair<std::shared_ptr<KeypointSequence>, std::shared_ptr<TrackObject>> SyntheticClip(int frames, double fps,
                                                                                         std::pair<int, int> image_size,
                                                                                         uint64_t seed,
                                                                                         double elevation_deg) {
  SynthClipOptions options;
  options.seed = seed;
  options.dense_per_frame = 0;
  options.camera.width = image_size.first, options.camera.height = image_size.second;
  options.camera.elevation_deg = elevation_deg;
  const BodyModel& body = BuiltinBody();
  SynthClip clip = MakeSynthClip(body, DemoMotion(body, frames, fps), options);
  return {std::make_shared<KeypointSequence>(std::move(clip.keypoints)),
          std::make_shared<TrackObject>(std::move(clip.truth), "truth")};
}

}  // namespace

void BindTracking(py::module_& module) {
  const TrackRequest defaults;
  module.def(
      "track",
      [](const std::optional<KeypointsArgument>& keypoints, const std::optional<Path>& dense,
         std::optional<double> dense_uv_sigma, const std::optional<Path>& part_labels, const std::optional<Path>& video,
         const std::string& view, int person, std::optional<double> fps, double min_confidence,
         const std::string& convention, const std::optional<CameraArgument>& camera, std::optional<double> focal_px,
         std::optional<double> focal_35mm, const std::optional<std::string>& camera_model,
         std::optional<std::pair<int, int>> image_size, bool still, const std::optional<Path>& camera_path_out,
         const std::optional<BodyArgument>& body, std::optional<double> stature_m, const std::optional<Path>& init,
         double init_weight, const std::optional<Path>& prior, const std::optional<Path>& lifter,
         std::optional<int> live_lag, const std::string& solver, int threads, int max_iterations, bool estimate_shape,
         bool uncertainty, bool ground, bool skip_unneeded, double rendered_weight, double velocity_weight,
         std::optional<double> straight_knees, const std::string& detector, const std::optional<Path>& pose_model,
         const std::optional<Path>& box_model, const std::optional<Path>& models, std::optional<double> detect_rate,
         bool mask, double begin_s, std::optional<double> end_s, const TurnArgument& rotate,
         std::optional<double> captured_fps, const std::optional<std::string>& hands, const py::object& progress) {
        TrackArguments arguments;
        TrackRequest& request = arguments.request;
        request.dense = TextOf(dense);
        request.dense_uv_sigma = dense_uv_sigma;
        request.part_labels = TextOf(part_labels);
        request.video = TextOf(video);
        request.view = view;
        request.person = person;
        request.fps = PositiveOr0(fps, "fps");
        request.min_confidence = min_confidence;
        request.convention = convention;
        request.focal_px = PositiveOr0(focal_px, "focal_px");
        request.focal_35mm_mm = PositiveOr0(focal_35mm, "focal_35mm");
        request.camera = camera_model.value_or("");
        BODYLOOM_CHECK(!camera_model || request.camera == "pinhole" || request.camera == "unknown-focal" ||
                           request.camera == "weak",
                       "camera_model: \"", request.camera, "\", expected pinhole, unknown-focal or weak");
        std::tie(request.image_width, request.image_height) = image_size.value_or(std::pair(0, 0));
        BODYLOOM_CHECK(!image_size || (request.image_width > 0 && request.image_height > 0),
                       "image_size: expected pixels above 0, found (", request.image_width, ", ", request.image_height,
                       ")");
        request.find_camera_motion = !still;
        request.camera_path_out = TextOf(camera_path_out);
        request.stature_m = PositiveOr0(stature_m, "stature_m");
        request.init = TextOf(init);
        request.prior = TextOf(prior);
        request.lifter = TextOf(lifter);
        request.live_lag = live_lag;
        request.detector = DetectorFrom(detector, pose_model, box_model, models);
        if (hands) request.detector.hands_and_faces = HandsAndFaceChoiceNamed(*hands);
        request.detect_rate = PositiveOr0(detect_rate, "detect_rate");
        request.use_mask = mask;
        request.from_s = begin_s;
        request.to_s = end_s.value_or(-1);
        request.turn_deg = TurnFrom(rotate);
        request.captured_fps = PositiveOr0(captured_fps, "captured_fps");
        request.straight_knees = straight_knees;
        TrackSequenceOptions& solve = request.solve;
        solve.initialiser_weight = init_weight;
        solve.solver = SequenceSolverFromString(solver);
        solve.num_threads = threads;
        solve.max_iterations = max_iterations;
        solve.estimate_shape = estimate_shape;
        solve.estimate_uncertainty = uncertainty;
        solve.skip_unneeded = skip_unneeded;
        solve.rendered_uv.weight = rendered_weight;
        solve.velocity_weight = velocity_weight;
        if (!ground) solve.ground = GroundOptions::Off();
        TakeCamera(camera, &request, &arguments.given);
        TakeKeypoints(keypoints, &arguments);
        TakeBody(body, &request, &arguments.given);
        arguments.name = NameOf(request);
        return RunTrack(std::move(arguments), progress);
      },
      py::arg("keypoints") = py::none(), py::kw_only(), py::arg("dense") = py::none(),
      py::arg("dense_uv_sigma") = py::none(), py::arg("part_labels") = py::none(), py::arg("video") = py::none(),
      py::arg("view") = "", py::arg("person") = 0, py::arg("fps") = py::none(), py::arg("min_confidence") = 0.0,
      py::arg("convention") = "", py::arg("camera") = py::none(), py::arg("focal_px") = py::none(),
      py::arg("focal_35mm") = py::none(), py::arg("camera_model") = py::none(), py::arg("image_size") = py::none(),
      py::arg("still") = false, py::arg("camera_path_out") = py::none(), py::arg("body") = py::none(),
      py::arg("stature_m") = py::none(), py::arg("init") = py::none(),
      py::arg("init_weight") = defaults.solve.initialiser_weight, py::arg("prior") = py::none(),
      py::arg("lifter") = py::none(), py::arg("live_lag") = py::none(),
      py::arg("solver") = ToString(defaults.solve.solver), py::arg("threads") = defaults.solve.num_threads,
      py::arg("max_iterations") = defaults.solve.max_iterations, py::arg("estimate_shape") = true,
      py::arg("uncertainty") = true, py::arg("ground") = true, py::arg("skip_unneeded") = true,
      py::arg("rendered_weight") = defaults.solve.rendered_uv.weight,
      py::arg("velocity_weight") = defaults.solve.velocity_weight, py::arg("straight_knees") = py::none(),
      py::arg("detector") = "heavy", py::arg("pose_model") = py::none(), py::arg("box_model") = py::none(),
      py::arg("models") = py::none(), py::arg("detect_rate") = py::none(), py::arg("mask") = true,
      py::arg("begin_s") = 0.0, py::arg("end_s") = py::none(), py::arg("rotate") = 0,
      py::arg("captured_fps") = py::none(), py::arg("hands") = py::none(), py::arg("progress") = py::none(),
      kTrackFunctionDoc);
  module.def("synthetic_clip", &SyntheticClip, py::arg("frames") = 180, py::kw_only(), py::arg("fps") = 30.0,
             py::arg("image_size") = std::pair(960, 720), py::arg("seed") = 1, py::arg("elevation_deg") = 8.0,
             py::call_guard<py::gil_scoped_release>(), kSyntheticClipDoc);
}

}  // namespace bodyloom::python
