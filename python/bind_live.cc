// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "geometry/base/check.h"
#include "geometry/body/posed_body.h"
#include "pipelines/track/track_request.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/python_callbacks.h"
#include "python/track_object.h"
#include "tracking/builtin_models.h"
#include "tracking/live/live_tracker.h"

namespace bodyloom::python {
namespace {

constexpr const char* kLiveTrackerDoc =
    R"(Tracks a person while the frames come in: one frame in, the pose of the frame `lag` frames before out.

names       the 2D joints of each frame: a convention ("coco17", ...) or a list
camera      Camera that is known; without it image_size (width, height) is needed and the focal length is estimated
weak        weak perspective, with image_size
body        Body, or a file; None: the built-in one
lag         frames that a pose waits for what comes behind it, 0 to 60
iterations  solver iterations a frame
threads     0: one a core; poses are the same for any number
prior, lifter  False leaves the built-in weights out
Time and memory of a frame are bounded. Raises ValueError for arguments that cannot be. Not two threads at a time push:
the second waits.)";

constexpr const char* kPushDoc = R"(The LiveFrame `lag` frames before this one, or None for the first `lag` frames.

timestamp  seconds, larger than the frame's before
keypoints  (K, 3): x and y in pixels, confidence; None: nothing was seen. Joints that are missing have confidence 0 or
           NaN.

Raises ValueError, and changes nothing, for a shape or time that cannot be.)";

constexpr const char* kFinishDoc =
    "The LiveFrames that are left, when no more will come. The next push() begins a new clip.";

constexpr const char* kLiveFrameDoc = R"(A pose that the live tracker hands out; it does not change any more.

Metres, camera frame; everything is NaN when the person is lost. Arrays are views.)";

/// A frame with what its numbers mean.
struct LiveFrameObject {
  LiveFrame frame;
  std::shared_ptr<const BodyModel> body;
  Eigen::Vector3d trans;  ///< of the body; zero for weak perspective, where the camera has it
  [[nodiscard]] BodyPose pose() const { return {frame.state.rotations, trans}; }
};

class LiveTrackerObject {
 public:
  LiveTrackerObject(const LandmarkNames& names, const std::optional<Camera>& camera,
                    std::optional<std::pair<int, int>> image_size, bool weak, const std::optional<BodyArgument>& body,
                    int lag, int iterations, int threads, bool prior, bool lifter, bool estimate_shape,
                    bool uncertainty)
      : body_(BodyFrom(body)) {
    LiveTrackerInput input;
    input.body = body_.get();
    LiveTrackerOptions options;
    std::string convention;
    std::tie(convention, input.landmarks) = ConventionFrom(names);
    options.solve.straight_knees_weight = StraightKneesWeight({}, convention);
    TakeCamera(camera, image_size, weak, &input, &options);
    options.lag = lag;
    options.iterations = iterations;
    CheckThreads(threads);
    options.solve.num_threads = threads;
    options.solve.estimate_shape = estimate_shape;
    options.solve.estimate_uncertainty = uncertainty;
    input = WithBuiltins(input);
    if (!prior) input.prior = nullptr;
    if (!lifter) input.lifter = nullptr;
    num_landmarks_ = py::ssize_t(input.landmarks.size());
    tracker_ = std::make_unique<LiveTracker>(input, options);
  }

  std::optional<LiveFrameObject> Push(double timestamp, const py::object& keypoints) {
    LiveObservations seen;
    seen.timestamp = timestamp;
    if (!keypoints.is_none()) {
      const auto values = NumbersFrom<float>(keypoints, "keypoints", {num_landmarks_, 3});
      const float* value = values.data();
      for (py::ssize_t k = 0; k < num_landmarks_; ++k, value += 3) {
        seen.keypoints.push_back({value[0], value[1], value[2]});
      }
    }
    const py::gil_scoped_release unlocked;
    const std::lock_guard<std::mutex> one_at_a_time(mutex_);
    std::optional<LiveFrame> frame = tracker_->Push(seen);
    if (!frame) return std::nullopt;
    return WithMeaning(std::move(*frame));
  }

  std::vector<LiveFrameObject> Finish() {
    const py::gil_scoped_release unlocked;
    const std::lock_guard<std::mutex> one_at_a_time(mutex_);
    std::vector<LiveFrameObject> frames;
    for (LiveFrame& frame : tracker_->Finish()) frames.push_back(WithMeaning(std::move(frame)));
    return frames;
  }

 private:
  static void TakeCamera(const std::optional<Camera>& camera, std::optional<std::pair<int, int>> image_size, bool weak,
                         LiveTrackerInput* input, LiveTrackerOptions* options) {
    BODYLOOM_CHECK(camera.has_value() != image_size.has_value(), "expected camera or image_size, and not both");
    BODYLOOM_CHECK(!weak || image_size, "weak: goes with image_size, found a camera");
    if (camera) {
      input->camera = *camera;
      return;
    }
    BODYLOOM_CHECK(image_size->first > 0 && image_size->second > 0, "image_size: expected pixels above 0, found (",
                   image_size->first, ", ", image_size->second, ")");
    input->camera.width = image_size->first, input->camera.height = image_size->second;
    options->solve.camera_knowledge = weak ? CameraKnowledge::kWeak : CameraKnowledge::kUnknownFocal;
  }

  LiveFrameObject WithMeaning(LiveFrame frame) const {
    const Eigen::Vector3d trans = tracker_->layout().BodyTranslation(frame.state);
    return {std::move(frame), body_, trans};
  }

  std::shared_ptr<const BodyModel> body_;
  py::ssize_t num_landmarks_ = 0;
  std::mutex mutex_;
  std::unique_ptr<LiveTracker> tracker_;
};

const LiveFrameObject& FrameOf(const py::object& self) { return self.cast<const LiveFrameObject&>(); }

/// (J, 3, 3); Eigen's matrices lie column by column.
py::array RotationsView(const py::object& self) {
  const std::vector<Eigen::Matrix3d>& rotations = FrameOf(self).frame.state.rotations;
  const py::ssize_t step = sizeof(double);
  return View(rotations.data()->data(), {py::ssize_t(rotations.size()), 3, 3}, {9 * step, step, 3 * step}, self);
}

py::array AxisAngleOf(const LiveFrameObject& self) {
  if (!IsFinite(self.frame.state)) {
    return ArrayOwning(std::vector<double>(3 * self.frame.state.rotations.size(), std::nan("")),
                       {py::ssize_t(3 * self.frame.state.rotations.size())});
  }
  const Eigen::VectorXd angles = AxisAngleFromPose(*self.body, self.pose());
  return py::array_t<double>(angles.size(), angles.data());
}

py::array JointsOf(const LiveFrameObject& self) {
  const MatrixX3d joints = PoseSkeleton(*self.body, self.body->RestJoints(self.frame.betas), self.pose()).joints;
  return py::array_t<double>({joints.rows(), Eigen::Index(3)}, joints.data());
}

std::string LiveFrameText(const LiveFrameObject& self) {
  return Concatenate("LiveFrame(", self.frame.index, ", ", self.frame.timestamp, " s, ", ToString(self.frame.status),
                     ")");
}

}  // namespace

void BindLive(py::module_& module) {
  py::class_<LiveFrameObject>(module, "LiveFrame", kLiveFrameDoc)
      .def_property_readonly(
          "index", [](const LiveFrameObject& self) { return self.frame.index; }, "Of the push() that brought it.")
      .def_property_readonly(
          "timestamp", [](const LiveFrameObject& self) { return self.frame.timestamp; }, "Seconds.")
      .def_property_readonly(
          "status", [](const LiveFrameObject& self) { return ToString(self.frame.status); },
          "\"tracked\", \"weak\", \"interpolated\" or \"lost\".")
      .def_property_readonly(
          "cut_before", [](const LiveFrameObject& self) { return self.frame.cut_before; },
          "Whether it does not continue the frame before.")
      .def_property_readonly("poses", &AxisAngleOf, "(3J,) float64: axis-angle, radians.")
      .def_property_readonly("rotations", &RotationsView, "(J, 3, 3) float64 view: rotation relative to the parent.")
      .def_property_readonly(
          "trans", [](const py::object& self) { return View(FrameOf(self).trans.data(), {py::ssize_t(3)}, self); },
          "(3,) float64 view, metres.")
      .def_property_readonly("joints", &JointsOf, "(J, 3) float64, metres.")
      .def_property_readonly(
          "betas", [](const py::object& self) { return MatrixView(FrameOf(self).frame.betas, self); },
          "(B,) float64 view: the shape as known then.")
      .def_property_readonly(
          "joint_sigma", [](const py::object& self) { return MatrixView(FrameOf(self).frame.joint_sigma, self); },
          "(J,) float64 view: standard deviations of the joints' positions about the mid-hip as known then, metres.")
      .def_property_readonly(
          "root_sigma", [](const LiveFrameObject& self) { return self.frame.root_sigma; },
          "Standard deviation of the mid-hip's own position as known then, metres.")
      .def_property_readonly(
          "camera", [](const LiveFrameObject& self) { return self.frame.camera; },
          "Of this frame, with the focal length as known then.")
      .def("__repr__", &LiveFrameText);
  const LiveTrackerOptions defaults;
  py::class_<LiveTrackerObject>(module, "LiveTracker", kLiveTrackerDoc)
      .def(py::init<const LandmarkNames&, const std::optional<Camera>&, std::optional<std::pair<int, int>>, bool,
                    const std::optional<BodyArgument>&, int, int, int, bool, bool, bool, bool>(),
           py::arg("names") = "coco17", py::kw_only(), py::arg("camera") = py::none(),
           py::arg("image_size") = py::none(), py::arg("weak") = false, py::arg("body") = py::none(),
           py::arg("lag") = defaults.lag, py::arg("iterations") = defaults.iterations, py::arg("threads") = 0,
           py::arg("prior") = true, py::arg("lifter") = true, py::arg("estimate_shape") = true,
           py::arg("uncertainty") = true)
      .def("push", &LiveTrackerObject::Push, py::arg("timestamp"), py::arg("keypoints") = py::none(), kPushDoc)
      .def("finish", &LiveTrackerObject::Finish, kFinishDoc);
}

}  // namespace bodyloom::python
