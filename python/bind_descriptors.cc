// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "data_tools/descriptors/describe_track.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/scene/track.h"
#include "pipelines/files.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/python_callbacks.h"
#include "python/track_object.h"
#include "render/uv_maps/descriptor_frames.h"
#include "render/uv_maps/live_descriptors.h"

namespace bodyloom::python {
namespace {

constexpr const char* kDescribeDoc =
    R"(How the surface of a tracked body lies and moves, as maps over its UV atlas: (T, C, size, size) float32.

Channels are the unit normal (3) and the velocities, m/s, of this frame and those before (3 * past): C = 3 + 3 * past.
Texel (row r, column c) is centred at u = (c + 0.5) / size, v = 1 - (r + 0.5) / size. Frames without a fit and texels
that show nothing are zero; nothing is NaN.

out        a file .npy (and .json beside it) instead of memory: returned is numpy.load(out, mmap_mode="r"); with
           half=True float16
body       Body, or a file; None: the track's own
past       velocity maps a frame, its own included, 0 to 1000
normals    False leaves them out
velocity   "savgol", "central", "backward" or "analytic"
frame      axes: "camera", "world" (the track's: y up) or "body" (turned with the pelvis)
weighting  of normals, by "area" or "angle"
gutter     texels around every chart that continue the surface
seen_only  texels that the camera does not see are zero
every      describes every n-th frame
threads    0: one a core; the same values for any number

Raises ValueError for options that cannot be, RuntimeError when the track is not the body's or a file cannot be
written; Ctrl-C leaves no file.)";

constexpr const char* kDescriptorFramesDoc =
    R"(The maps of describe(), frame by frame: frames[t] is (C, size, size) float32.

Frames in rising order cost one normal map and one velocity map each; any other order gives the same values. Options as
of describe(). Two threads may share it: the second waits.)";

constexpr const char* kPlanesDoc = R"(The maps of frame t, (C, size, size) float32, into `out` when it is given.

`out` is a float32 array of that shape in C order that can be written to; it is returned.)";

constexpr const char* kLiveDescriptorsDoc =
    R"(The maps of a body that is tracked live: poses go in one by one, maps come out at once.

As describe() with velocity="backward", the only one that needs no later frame. Raises ValueError for options that
cannot be and for a body without UV coordinates.)";

constexpr const char* kLivePushDoc = R"(The maps of a pose at `timestamp` seconds: (C, size, size) float32.

poses (3J,) radians, trans (3,) metres and betas (B,) as a LiveFrame has them; poses None or not finite: the person is
lost, all maps are zero and the next pose begins anew. Raises ValueError, and changes nothing, when the time does not
grow or the pose is not the body's.)";

/// Arguments common to describe() and DescriptorFrames().
struct DescriptorArguments {
  int size = 128, past = 10;
  bool normals = true;
  std::string velocity, frame, weighting;
  bool seen_only = false;
  int gutter = 1, threads = 0;
};

NormalWeighting WeightingFrom(const std::string& name) {
  BODYLOOM_CHECK(name == "area" || name == "angle", "weighting: \"", name, "\", expected area or angle");
  return name == "angle" ? NormalWeighting::kAngle : NormalWeighting::kArea;
}

void SetOptions(const DescriptorArguments& arguments, const Track& track, DescriptorOptions* options) {
  options->texels.width = options->texels.height = arguments.size;
  options->texels.gutter = arguments.gutter;
  options->past = arguments.past;
  options->normals = arguments.normals;
  SetVelocity(arguments.velocity, options);
  options->frame = SurfaceFrameNamed(arguments.frame);
  if (options->frame == SurfaceFrame::kWorld)
    options->camera_pose = track.world ? track.world->camera_pose() : LevelCamera();
  options->weighting = WeightingFrom(arguments.weighting);
  options->seen_only = arguments.seen_only;
  CheckThreads(arguments.threads);
  options->num_threads = ThreadsFor(arguments.threads);
}

class DescriptorFramesObject {
 public:
  DescriptorFramesObject(std::shared_ptr<TrackObject> track, std::shared_ptr<const BodyModel> body,
                         const DescriptorArguments& arguments)
      : track_(std::move(track)), body_(std::move(body)) {
    RequireTrackFitsBody(track_->track, *body_, track_->name);
    DescriptorOptions options;
    SetOptions(arguments, track_->track, &options);
    frames_ = std::make_unique<DescriptorFrames>(*body_, track_->track, options);
  }

  [[nodiscard]] int num_frames() const { return frames_->num_frames(); }
  [[nodiscard]] std::vector<py::ssize_t> shape() const {
    return {frames_->channels(), frames_->height(), frames_->width()};
  }
  [[nodiscard]] bool HasFit(int t) const {
    BODYLOOM_CHECK(t >= 0 && t < num_frames(), "frame ", t, " is outside the track's ", num_frames(), " frames");
    return frames_->HasFit(t);
  }

  py::array Planes(int t, const py::object& out) {
    if (out.is_none()) {
      py::array_t<float> planes(shape());
      Fill(t, planes.mutable_data());
      return planes;
    }
    py::array_t<float, py::array::c_style> planes = WritableOut(out);
    Fill(t, planes.mutable_data());
    return planes;
  }

  /// Without the interpreter's lock: those of several frames, one after another.
  void FillSeveral(std::span<const int> frames, float* out) {
    const std::lock_guard<std::mutex> one_at_a_time(mutex_);
    frames_->Planes(frames, {out, frames.size() * frames_->frame_size()});
  }

 private:
  void Fill(int t, float* out) {
    const py::gil_scoped_release unlocked;
    const std::lock_guard<std::mutex> one_at_a_time(mutex_);
    frames_->Planes(t, {out, frames_->frame_size()});
  }

  py::array_t<float, py::array::c_style> WritableOut(const py::object& out) const {
    const std::string expected = Concatenate("out: expected a writable float32 array of shape (", frames_->channels(),
                                             ", ", frames_->height(), ", ", frames_->width(), ") in C order");
    if (!py::isinstance<py::array_t<float, py::array::c_style>>(out)) {
      throw py::type_error(expected + ", found another kind of array");
    }
    auto planes = out.cast<py::array_t<float, py::array::c_style>>();
    const std::vector<py::ssize_t> found(planes.shape(), planes.shape() + planes.ndim());
    BODYLOOM_CHECK(found == shape() && planes.writeable(), expected, ", found shape ",
                   std::string(py::str(planes.attr("shape"))), planes.writeable() ? "" : " that is read-only");
    return planes;
  }

  std::shared_ptr<TrackObject> track_;
  std::shared_ptr<const BodyModel> body_;
  std::mutex mutex_;
  std::unique_ptr<DescriptorFrames> frames_;
};

py::array DescribeInMemory(DescriptorFramesObject* frames, int every, const py::object& progress) {
  std::vector<int> chosen;
  for (int t = 0; t < frames->num_frames(); t += every) chosen.push_back(t);
  std::vector<py::ssize_t> shape = frames->shape();
  const py::ssize_t frame_size = shape[0] * shape[1] * shape[2];
  shape.insert(shape.begin(), py::ssize_t(chosen.size()));
  py::array_t<float> maps(shape);
  float* out = maps.mutable_data();
  PythonCallbacks(progress).Run([&](const PipelineCallbacks& callbacks) {
    constexpr size_t kFramesAtATime = 32;  // between two looks at Ctrl-C
    const std::span<const int> all(chosen);
    for (size_t i = 0; i < all.size(); i += kFramesAtATime) {
      callbacks.Update("describing", double(i) / double(all.size()));
      frames->FillSeveral(all.subspan(i, std::min(kFramesAtATime, all.size() - i)), out + py::ssize_t(i) * frame_size);
    }
  });
  return maps;
}

py::object DescribeToFile(const TrackObject& track, const BodyModel& body, const std::string& out,
                          const DescriptorArguments& arguments, int every, bool half, const py::object& progress) {
  BODYLOOM_CHECK(out.ends_with(".npy"), "out ", out, ": expected a name that ends in .npy");
  RequireTrackFitsBody(track.track, body, track.name);
  RequireWritable(out);
  RequireWritable(DescriptorHeaderPath(out));
  DescribeTrackOptions options;
  SetOptions(arguments, track.track, &options);
  options.every = every;
  options.half = half;
  PythonCallbacks(progress).Run([&](const PipelineCallbacks& callbacks) {
    DescribeTrack(body, track.track, out, options, [&](double fraction) { callbacks.Update("describing", fraction); });
  });
  return py::module_::import("numpy").attr("load")(out, py::arg("mmap_mode") = "r");
}

class LiveDescriptorsObject {
 public:
  LiveDescriptorsObject(std::shared_ptr<const BodyModel> body, const LiveDescriptorsOptions& options)
      : body_(std::move(body)), size_(options.texels.width), live_(*body_, options) {}

  py::array Push(double timestamp, const py::object& poses, const py::object& trans, const py::object& betas) {
    std::optional<BodyPose> pose;
    Eigen::VectorXd shape;
    if (!betas.is_none()) shape = VectorFrom(betas, "betas", "B");
    if (!poses.is_none()) {
      const Eigen::VectorXd angles = VectorFrom(poses, "poses", 3 * body_->num_joints());
      const Eigen::VectorXd place =
          trans.is_none() ? Eigen::VectorXd(Eigen::Vector3d::Zero()) : VectorFrom(trans, "trans", 3);
      if (angles.allFinite() && place.allFinite()) pose = PoseFromAxisAngle(*body_, angles, place);
    }
    py::array_t<float> planes({py::ssize_t(live_.channels()), py::ssize_t(size_), py::ssize_t(size_)});
    float* out = planes.mutable_data();
    {
      const py::gil_scoped_release unlocked;
      const std::lock_guard<std::mutex> one_at_a_time(mutex_);
      live_.Push(timestamp, pose ? &*pose : nullptr, shape, {out, live_.frame_size()});
    }
    return planes;
  }

 private:
  std::shared_ptr<const BodyModel> body_;
  int size_ = 0;
  std::mutex mutex_;
  LiveDescriptors live_;
};

}  // namespace

void BindDescriptors(py::module_& module) {
  const DescriptorOptions defaults;
  const std::string velocity = VelocityName(defaults), axes = ToString(defaults.frame);
  module.def(
      "describe",
      [](const TrackArgument& track_argument, const std::optional<Path>& out, const std::optional<BodyArgument>& body,
         int size, int past, bool normals, const std::string& velocity, const std::string& frame,
         const std::string& weighting, bool seen_only, int gutter, int every, bool half, int threads,
         const py::object& progress) -> py::object {
        const std::shared_ptr<TrackObject> track = TrackFrom(track_argument);
        const std::shared_ptr<const BodyModel> body_model = BodyOf(*track, body);
        const DescriptorArguments arguments{size,      past,      normals, velocity, frame,
                                            weighting, seen_only, gutter,  threads};
        BODYLOOM_CHECK(every >= 1, "every: expected 1 or more, found ", every);
        if (out) return DescribeToFile(*track, *body_model, out->string(), arguments, every, half, progress);
        BODYLOOM_CHECK(!half, "half: float16 is of files; give out");
        DescriptorFramesObject frames(track, body_model, arguments);
        return DescribeInMemory(&frames, every, progress);
      },
      py::arg("track"), py::kw_only(), py::arg("out") = py::none(), py::arg("body") = py::none(),
      py::arg("size") = defaults.texels.width, py::arg("past") = defaults.past, py::arg("normals") = true,
      py::arg("velocity") = velocity, py::arg("frame") = axes, py::arg("weighting") = "area",
      py::arg("seen_only") = false, py::arg("gutter") = defaults.texels.gutter, py::arg("every") = 1,
      py::arg("half") = false, py::arg("threads") = 0, py::arg("progress") = py::none(), kDescribeDoc);
  py::class_<DescriptorFramesObject>(module, "DescriptorFrames", kDescriptorFramesDoc)
      .def(py::init([](const TrackArgument& track_argument, const std::optional<BodyArgument>& body, int size, int past,
                       bool normals, const std::string& velocity, const std::string& frame,
                       const std::string& weighting, bool seen_only, int gutter, int threads) {
             std::shared_ptr<TrackObject> track = TrackFrom(track_argument);
             std::shared_ptr<const BodyModel> body_model = BodyOf(*track, body);
             return std::make_unique<DescriptorFramesObject>(
                 std::move(track), std::move(body_model),
                 DescriptorArguments{size, past, normals, velocity, frame, weighting, seen_only, gutter, threads});
           }),
           py::arg("track"), py::kw_only(), py::arg("body") = py::none(), py::arg("size") = defaults.texels.width,
           py::arg("past") = defaults.past, py::arg("normals") = true, py::arg("velocity") = velocity,
           py::arg("frame") = axes, py::arg("weighting") = "area", py::arg("seen_only") = false,
           py::arg("gutter") = defaults.texels.gutter, py::arg("threads") = 0)
      .def_property_readonly(
          "shape", [](const DescriptorFramesObject& self) { return py::tuple(py::cast(self.shape())); },
          "(C, height, width) of a frame.")
      .def("has_fit", &DescriptorFramesObject::HasFit, py::arg("frame"),
           "Whether the track has a pose in this frame; without one its maps are zero.")
      .def("planes", &DescriptorFramesObject::Planes, py::arg("frame"), py::arg("out") = py::none(), kPlanesDoc)
      .def("__len__", &DescriptorFramesObject::num_frames)
      .def(
          "__getitem__",
          [](DescriptorFramesObject& self, int frame) {
            const int t = frame < 0 ? frame + self.num_frames() : frame;
            if (t < 0 || t >= self.num_frames()) {
              throw py::index_error(
                  Concatenate("frame ", frame, " is outside the track's ", self.num_frames(), " frames"));
            }
            return self.Planes(t, py::none());
          },
          py::arg("frame"));
  py::class_<LiveDescriptorsObject>(module, "LiveDescriptors", kLiveDescriptorsDoc)
      .def(py::init([](const std::optional<BodyArgument>& body, int size, int past, bool normals,
                       const std::string& weighting, int gutter) {
             LiveDescriptorsOptions options;
             options.texels.width = options.texels.height = size;
             options.texels.gutter = gutter;
             options.past = past;
             options.normals = normals;
             options.weighting = WeightingFrom(weighting);
             return std::make_unique<LiveDescriptorsObject>(BodyFrom(body), options);
           }),
           py::kw_only(), py::arg("body") = py::none(), py::arg("size") = defaults.texels.width,
           py::arg("past") = defaults.past, py::arg("normals") = true, py::arg("weighting") = "area",
           py::arg("gutter") = defaults.texels.gutter)
      .def("push", &LiveDescriptorsObject::Push, py::arg("timestamp"), py::arg("poses") = py::none(),
           py::arg("trans") = py::none(), py::arg("betas") = py::none(), kLivePushDoc);
}

}  // namespace bodyloom::python
