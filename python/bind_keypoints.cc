// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "data_tools/observations/keypoint_conventions.h"
#include "data_tools/observations/load_detections.h"
#include "data_tools/observations/observations_npz.h"
#include "geometry/base/check.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/keypoints_object.h"
#include "python/python_callbacks.h"
#include "python/track_object.h"

namespace bodyloom::python {
namespace {

constexpr const char* kKeypointsDoc = R"(2D joints of one person in every frame of a clip, as a detector saw them.

points      (T, K, 3) float32: x and y in pixels (the top-left pixel's centre is 0, 0), confidence in [0, 1]; a
            joint is missing when its confidence is 0 or a coordinate is not finite
names       the K joints' names, or a convention: "coco17", "body25", "body25b", "openpose_coco18",
            "coco_wholebody23", "halpe26", "mediapipe33", "human36m17"
timestamps  (T,) seconds that grow; without them frame t is at t / fps
image_size  (width, height) in pixels; (0, 0) when it is not known

Raises ValueError when shapes, names or times contradict each other.)";

constexpr const char* kKeypointsLoadDoc = R"(The detections in a file or folder, recognised by what it holds.

Read are OpenPose, COCO, AlphaPose, MMPose, Ultralytics, easy_ViTPose, MediaPipe, DeepLabCut, AIST++, FreeMoCap,
VideoPose3D, arrays of COCO's joints and this project's own .npz. `view` names the camera of a file that has several,
`person` who is meant (0: the largest and longest in view), `fps` the frame rate of a file that does not say,
`image_size` the images' size where it is known, `convention` the order of the joints of OpenPose, arrays and
VideoPose3D when it should not be recognised. Joints below `min_confidence` count as missing. Broken files of a folder
are frames without joints and logged to the logger "bodyloom". Hands and faces that a file holds are in the
PersonKeypoints that it returns then.
Raises RuntimeError naming the file, what was found and what was expected.)";

std::vector<double> TimestampsFrom(const py::object& timestamps, double fps, py::ssize_t num_frames) {
  std::vector<double> times;
  if (timestamps.is_none()) {
    BODYLOOM_CHECK(fps > 0 && fps <= 1e6, "fps: expected frames a second above 0, found ", fps);
    for (py::ssize_t t = 0; t < num_frames; ++t) times.push_back(double(t) / fps);
    return times;
  }
  const auto given = NumbersFrom<double>(timestamps, "timestamps", {num_frames});
  times.assign(given.data(), given.data() + given.size());
  for (size_t t = 0; t < times.size(); ++t) {
    BODYLOOM_CHECK(std::isfinite(times[t]) && (t == 0 || times[t] > times[t - 1]), "timestamps: entry ", t, " is ",
                   times[t], ", expected finite seconds that grow");
  }
  return times;
}

std::shared_ptr<KeypointSequence> MakeKeypoints(const py::object& points, const LandmarkNames& names,
                                                const py::object& timestamps, double fps,
                                                std::pair<int, int> image_size) {
  auto sequence = std::make_shared<KeypointSequence>();
  std::tie(sequence->convention, sequence->names) = ConventionFrom(names);
  const auto K = py::ssize_t(sequence->names.size());
  const auto values = NumbersFrom<float>(points, "points", {"T", K, 3});
  BODYLOOM_CHECK(values.shape(0) > 0, "points: expected at least one frame, found shape (0, ", K, ", 3)");
  BODYLOOM_CHECK(image_size.first >= 0 && image_size.second >= 0, "image_size: expected pixels, found (",
                 image_size.first, ", ", image_size.second, ")");
  sequence->timestamps = TimestampsFrom(timestamps, fps, values.shape(0));
  sequence->image_width = image_size.first;
  sequence->image_height = image_size.second;
  const float* value = values.data();
  for (py::ssize_t i = 0; i < values.shape(0) * K; ++i, value += 3) {
    const bool known = std::isfinite(value[2]) && value[2] > 0;
    sequence->points.push_back({value[0], value[1], known ? std::min(value[2], 1.0F) : 0});
  }
  return sequence;
}

py::object LoadKeypoints(const Path& path, const std::string& view, int person, std::optional<double> fps,
                         std::optional<std::pair<int, int>> image_size, double min_confidence,
                         const std::string& convention) {
  LoadDetectionsOptions options;
  options.view = view;
  options.person = person;
  options.fps = fps.value_or(0);
  std::tie(options.image_width, options.image_height) = image_size.value_or(std::pair(0, 0));
  options.min_confidence = min_confidence;
  options.convention = convention;
  return KeypointsObject(PythonCallbacks(py::none()).Run([&](const PipelineCallbacks& callbacks) {
    std::vector<std::string> warnings;
    PersonDetections found = LoadPersonDetections(path.string(), options, &warnings);
    for (const std::string& warning : warnings) callbacks.Message(warning);
    return found;
  }));
}

constexpr const char* kPersonKeypointsDoc = R"(Keypoints of a person whose hands or face were found too.

A hand's 21 points are the wrist, then of thumb, index, middle, ring and little finger each the joint nearest to the
wrist, the next two and the tip; a face's 68 are those of 300-W: jaw, brows, nose, eyes, lips. Left and right are the
person's. Arrays are copies.)";

/// Numbers of each frame, written by fill(frame, its numbers) where the frame has hands or a face; else `absent`.
template <typename Fill>
py::array FramesArray(const PersonKeypoints& person, const std::vector<py::ssize_t>& shape, float absent,
                      const Fill& fill) {
  size_t size = 1;
  for (const py::ssize_t n : shape) size *= size_t(n);
  const auto& frames = person.hands_and_face.frames;
  std::vector<float> values(frames.size() * size, absent);
  for (size_t t = 0; t < frames.size(); ++t) {
    if (frames[t]) fill(*frames[t], &values[t * size]);
  }
  std::vector<py::ssize_t> whole = {py::ssize_t(frames.size())};
  whole.insert(whole.end(), shape.begin(), shape.end());
  return ArrayOwning(std::move(values), std::move(whole));
}

/// Copies a part of every hand that is there: member(hand) is an array of floats or of structures of them.
template <typename Member>
py::array OfHands(const PersonKeypoints& person, const std::vector<py::ssize_t>& shape, float absent,
                  const Member& member) {
  return FramesArray(person, shape, absent, [&](const HandsAndFace& frame, float* to) {
    for (size_t side = 0; side < 2; ++side) {
      if (!frame.hands[side]) continue;
      const auto& values = member(*frame.hands[side]);
      const auto* first = reinterpret_cast<const float*>(values.data());
      const size_t count = sizeof(values) / sizeof(float);
      std::copy(first, first + count, to + side * count);
    }
  });
}

void BindPersonKeypoints(py::module_& module) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  py::class_<PersonKeypoints, KeypointSequence, std::shared_ptr<PersonKeypoints>>(module, "PersonKeypoints",
                                                                                  kPersonKeypointsDoc)
      .def_property_readonly(
          "hands",
          [](const PersonKeypoints& self) {
            return OfHands(
                self, {2, kHandPoints, 3}, 0, [](const auto& hand) -> const auto& { return hand.points; });
          },
          "(T, 2, 21, 3) float32, left hand first: x and y in pixels, confidence in [0, 1]; 0: missing.")
      .def_property_readonly(
          "hand_sigma_px",
          [](const PersonKeypoints& self) {
            return OfHands(
                self, {2, kHandPoints}, 0, [](const auto& hand) -> const auto& { return hand.sigma_px; });
          },
          "(T, 2, 21) float32: standard deviation of a point along an axis, pixels; 0: not known.")
      .def_property_readonly(
          "hand_metres",
          [](const PersonKeypoints& self) {
            return OfHands(
                self, {2, kHandPoints, 3}, kNan, [](const auto& hand) -> const auto& { return hand.metres; });
          },
          "(T, 2, 21, 3) float32: metres about the hand's middle, x right, y down, z away from the camera; NaN: not "
          "known.")
      .def_property_readonly(
          "face",
          [](const PersonKeypoints& self) {
            return FramesArray(self, {kFacePoints, 3}, 0, [](const HandsAndFace& frame, float* to) {
              if (frame.face) std::copy_n(&frame.face->points.data()->x, 3 * kFacePoints, to);
            });
          },
          "(T, 68, 3) float32: x and y in pixels, confidence in [0, 1]; 0: missing.")
      .def_property_readonly(
          "face_sigma_px",
          [](const PersonKeypoints& self) {
            return FramesArray(self, {}, 0, [](const HandsAndFace& frame, float* to) {
              if (frame.face) *to = frame.face->sigma_px;
            });
          },
          "(T,) float32: standard deviation of a face's points along an axis, pixels; 0: not known.")
      .def_property_readonly(
          "face_depth_px",
          [](const PersonKeypoints& self) {
            return FramesArray(self, {kFacePoints}, kNan, [](const HandsAndFace& frame, float* to) {
              if (frame.face) std::copy(frame.face->depth_px.begin(), frame.face->depth_px.end(), to);
            });
          },
          "(T, 68) float32: relative depth of a face's points, pixels, smaller is nearer; NaN: not known.");
}

std::string KeypointsText(const KeypointSequence& keypoints) {
  return Concatenate("Keypoints(", keypoints.num_frames(), " frames, ", keypoints.num_points(), " joints of ",
                     keypoints.convention, ", image ", keypoints.image_width, "x", keypoints.image_height, ")");
}

}  // namespace

py::object KeypointsObject(PersonDetections person) {
  if (person.hands_and_face.empty()) return py::cast(std::make_shared<KeypointSequence>(std::move(person.body)));
  auto object = std::make_shared<PersonKeypoints>();
  static_cast<KeypointSequence&>(*object) = std::move(person.body);
  object->hands_and_face = std::move(person.hands_and_face);
  return py::cast(std::move(object));
}

void BindKeypoints(py::module_& module) {
  static_assert(sizeof(Keypoint) == 3 * sizeof(float), "keypoints are seen as rows of three");
  py::class_<KeypointSequence, std::shared_ptr<KeypointSequence>>(module, "Keypoints", kKeypointsDoc)
      .def(py::init(&MakeKeypoints), py::arg("points"), py::kw_only(), py::arg("names") = "coco17",
           py::arg("timestamps") = py::none(), py::arg("fps") = 30.0, py::arg("image_size") = std::pair(0, 0))
      .def_static("load", &LoadKeypoints, py::arg("path"), py::kw_only(), py::arg("view") = "", py::arg("person") = 0,
                  py::arg("fps") = py::none(), py::arg("image_size") = py::none(), py::arg("min_confidence") = 0.0,
                  py::arg("convention") = "", kKeypointsLoadDoc)
      .def(
          "save",
          [](const KeypointSequence& self, const Path& path) { WriteObservations(path.string(), &self, nullptr); },
          py::arg("path"), py::call_guard<py::gil_scoped_release>(),
          "Writes this project's .npz of observations, whole or not at all; load() reads it again. Raises RuntimeError "
          "naming the file.")
      .def_property_readonly(
          "points",
          [](const py::object& self) {
            const auto& keypoints = self.cast<const KeypointSequence&>();
            return View(&keypoints.points.data()->x, {keypoints.num_frames(), keypoints.num_points(), 3}, self);
          },
          "(T, K, 3) float32 view: x and y in pixels, confidence in [0, 1].")
      .def_property_readonly(
          "timestamps",
          [](const py::object& self) {
            const auto& times = self.cast<const KeypointSequence&>().timestamps;
            return View(times.data(), {py::ssize_t(times.size())}, self);
          },
          "(T,) float64 view, seconds.")
      .def_readonly("names", &KeypointSequence::names, "The K joints' names.")
      .def_readonly("convention", &KeypointSequence::convention, "Name of the detector's order of joints.")
      .def_property_readonly(
          "image_size", [](const KeypointSequence& self) { return std::pair(self.image_width, self.image_height); },
          "(width, height) in pixels; (0, 0) when it is not known.")
      .def("__len__", &KeypointSequence::num_frames)
      .def("__repr__", &KeypointsText);
  BindPersonKeypoints(module);
}

}  // namespace bodyloom::python
