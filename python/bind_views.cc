// SPDX-License-Identifier: Apache-2.0
// Several cameras: tracks and rigs. docs/python.md.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <stdlib.h>

#include <cerrno>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "data_tools/motion/track_io.h"
#include "data_tools/observations/observations_npz.h"
#include "data_tools/observations/rig_io.h"
#include "geometry/base/check.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/rig.h"
#include "pipelines/track/track_views_clip.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/python_callbacks.h"
#include "python/track_object.h"

namespace bodyloom::python {
namespace {

constexpr const char* kRigCameraDoc = R"(One camera of a rig: intrinsics, pose and clock.

camera_from_rig  (4, 4): a point in the rig's frame, which is that of its first camera, to this camera's frame, metres;
                 None: the first camera's own
offset_s, rate, middle_s   the camera's clock shows t + offset_s + rate (t - middle_s) when the first one's shows t;
                 offset_s=nan: not known
Standard deviations are 0 where a value was given and nan where they are not known.
Raises ValueError for a pose or a clock that cannot be.)";

constexpr const char* kTrackViewsDoc = R"(Fits one body to several cameras that stand still and filmed the same person.

keypoints     a list, for each camera Keypoints or the file or folder of a detector, the track's first; or one file that
              holds several views, whose names `views` has
views         names of the views in such a file, or of the cameras
cameras       what is known: a list of RigCameras or a file, by name or in the order of the views; `known` says how much
              of it is used, "intrinsics", "poses" or "clocks" (and what comes before)
same_lens     the cameras are of one kind and not zoomed, so that their focal lengths are alike
image_size, fps, focal_px, focal_35mm, min_confidence, convention   of all views that do not say themselves
body          file; the rest as of track()

Returns (track, rig): the Track in the frame and at the moments of the first camera, which is what `bodyloom track`
writes, to the byte, and the RigCameras of the views that were used, in their order. A view that shows another motion is
left out. Raises as track(), and RuntimeError where no other view shows the motion of the first.)";

/// A folder that is removed with what is in it.
class TemporaryViews {
 public:
  TemporaryViews() : path_((std::filesystem::temp_directory_path() / "bodyloom_views_XXXXXX").string()) {
    if (::mkdtemp(path_.data()) == nullptr) {
      throw std::runtime_error(path_ + ": cannot be made: " + std::generic_category().message(errno));
    }
  }
  ~TemporaryViews() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryViews(const TemporaryViews&) = delete;
  TemporaryViews& operator=(const TemporaryViews&) = delete;
  [[nodiscard]] std::string File(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

RigCamera MakeRigCamera(const std::string& name, const Camera& camera, const py::object& camera_from_rig,
                        double offset_s, double rate, double middle_s, double rotation_sigma_rad,
                        double translation_sigma_m, double focal_log_sigma, double offset_sigma_s, double rate_sigma) {
  BODYLOOM_CHECK(camera.model == CameraModel::kPinhole, "camera: expected a pinhole camera, found ",
                 ToString(camera.model));
  BODYLOOM_CHECK(!std::isinf(offset_s) && std::isfinite(middle_s) && std::isfinite(rate) && rate > -1,
                 "offset_s, rate, middle_s: expected finite numbers and a rate above -1, found ", offset_s, ", ", rate,
                 ", ", middle_s);
  for (const double sigma : {rotation_sigma_rad, translation_sigma_m, focal_log_sigma, offset_sigma_s, rate_sigma}) {
    BODYLOOM_CHECK(std::isnan(sigma) || sigma >= 0, "a standard deviation is ", sigma, ", expected 0 or more, or nan");
  }
  RigCamera result{
      name,           camera,    {}, offset_s, rate, middle_s, rotation_sigma_rad, translation_sigma_m, focal_log_sigma,
      offset_sigma_s, rate_sigma};
  if (camera_from_rig.is_none()) return result;
  const auto given = NumbersFrom<double>(camera_from_rig, "camera_from_rig", {4, 4});
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(given.data());
  result.camera_from_rig.camera_from_world_rotation = matrix.topLeftCorner<3, 3>();
  result.camera_from_rig.camera_from_world_translation = matrix.topRightCorner<3, 1>();
  BODYLOOM_CHECK(IsRotation(matrix.topLeftCorner<3, 3>(), 1e-6) && matrix.allFinite() &&
                     matrix.row(3) == Eigen::RowVector4d(0, 0, 0, 1),
                 "camera_from_rig: expected a rotation, metres, and the last row 0, 0, 0, 1");
  return result;
}

py::array PoseOfRigCamera(const RigCamera& self) {
  Eigen::Matrix<double, 4, 4, Eigen::RowMajor> pose = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>::Identity();
  pose.topLeftCorner<3, 3>() = self.camera_from_rig.camera_from_world_rotation;
  pose.topRightCorner<3, 1>() = self.camera_from_rig.camera_from_world_translation;
  return py::array_t<double>({4, 4}, pose.data());
}

using ViewArgument = std::variant<std::shared_ptr<KeypointSequence>, Path>;
using ViewsArgument = std::variant<std::vector<ViewArgument>, Path>;

using TrackOfViews = std::pair<std::shared_ptr<TrackObject>, std::vector<RigCamera>>;

/// Data in memory become files of the folder, since the pipeline is from files to files.
TrackOfViews RunTrackViews(TrackViewsRequest request, const std::vector<ViewArgument>& views,
                           const std::optional<RigArgument>& cameras, const py::object& progress) {
  const TemporaryViews folder;
  for (size_t v = 0; v < views.size(); ++v) {
    if (const auto* path = std::get_if<Path>(&views[v])) {
      request.view_detections.push_back(path->string());
      continue;
    }
    request.view_detections.push_back(folder.File("view" + std::to_string(v + 1) + ".npz"));
    WriteObservations(request.view_detections.back(), std::get<std::shared_ptr<KeypointSequence>>(views[v]).get(),
                      nullptr);
  }
  if (cameras) {
    if (const auto* path = std::get_if<Path>(&*cameras)) {
      request.cameras = path->string();
    } else {
      request.cameras = folder.File("cameras.json");
      WriteRig(request.cameras, std::get<std::vector<RigCamera>>(*cameras));
    }
  }
  request.out = folder.File("track.npz");
  request.rig_out = folder.File("rig.json");
  CheckThreads(request.solve.num_threads);
  GivenInMemory given;
  const std::shared_ptr<const BodyModel> body = BodyToKeep(request, &given);
  return PythonCallbacks(progress).Run([&](const PipelineCallbacks& callbacks) {
    TrackReport report = TrackViewsClip(request, callbacks);
    if (!report.solve.IsUsable()) throw std::runtime_error("nothing could be tracked: " + report.solve.message);
    auto track = std::make_shared<TrackObject>(ReadTrack(request.out), "views", body);
    track->summary = std::move(report.solve);
    return TrackOfViews(track, ReadRig(request.rig_out));
  });
}

}  // namespace

void BindViews(py::module_& module) {
  py::class_<RigCamera>(module, "RigCamera", kRigCameraDoc)
      .def(py::init(&MakeRigCamera), py::arg("name"), py::arg("camera"), py::arg("camera_from_rig") = py::none(),
           py::kw_only(), py::arg("offset_s") = 0.0, py::arg("rate") = 0.0, py::arg("middle_s") = 0.0,
           py::arg("rotation_sigma_rad") = 0.0, py::arg("translation_sigma_m") = 0.0, py::arg("focal_log_sigma") = 0.0,
           py::arg("offset_sigma_s") = 0.0, py::arg("rate_sigma") = 0.0)
      .def("time_at", &RigCamera::TimeAt, py::arg("first_s"),
           "Seconds that this camera's clock shows when the first camera's shows `first_s`; nan without a clock.")
      .def("first_time_at", &RigCamera::FirstTimeAt, py::arg("own_s"),
           "Seconds that the first camera's clock shows when this one's shows `own_s`; nan without a clock.")
      .def_readonly("name", &RigCamera::name, "Of the view.")
      .def_property_readonly(
          "camera", [](const RigCamera& self) { return self.camera; }, "Its intrinsics.")
      .def_property_readonly("camera_from_rig", &PoseOfRigCamera, "(4, 4) float64: its pose, metres.")
      .def_readonly("offset_s", &RigCamera::offset_s, "Of the clock, seconds; nan: not known.")
      .def_readonly("rate", &RigCamera::rate, "Of the clock.")
      .def_readonly("middle_s", &RigCamera::middle_s, "Of the clock, seconds of the first camera's.")
      .def_readonly("rotation_sigma_rad", &RigCamera::rotation_sigma_rad, "Of the pose, about one axis.")
      .def_readonly("translation_sigma_m", &RigCamera::translation_sigma_m, "Of the pose, along one axis.")
      .def_readonly("focal_log_sigma", &RigCamera::focal_log_sigma, "Of the logarithm of the focal length.")
      .def_readonly("offset_sigma_s", &RigCamera::offset_sigma_s, "Of the clock's offset.")
      .def_readonly("rate_sigma", &RigCamera::rate_sigma, "Of the clock's rate.")
      .def("__repr__", [](const RigCamera& self) {
        return Concatenate("RigCamera(", self.name, ", ", self.camera.width, "x", self.camera.height, ", focal length ",
                           self.camera.fx, " px)");
      });
  module.def(
      "read_rig", [](const Path& path) { return ReadRig(path.string()); }, py::arg("path"),
      py::call_guard<py::gil_scoped_release>(),
      "The RigCameras of a rig.json. Raises RuntimeError naming file, place and what was expected.");
  module.def(
      "write_rig", [](const Path& path, const std::vector<RigCamera>& rig) { WriteRig(path.string(), rig); },
      py::arg("path"), py::arg("rig"), py::call_guard<py::gil_scoped_release>(),
      "Writes RigCameras to a rig.json, whole or not at all. Raises ValueError for a rig without cameras, RuntimeError "
      "naming the file.");
  const TrackViewsRequest defaults;
  module.def(
      "track_views",
      [](const ViewsArgument& keypoints, const std::vector<std::string>& views,
         const std::optional<RigArgument>& cameras, const std::string& known, bool same_lens,
         std::optional<std::pair<int, int>> image_size, std::optional<double> fps, std::optional<double> focal_px,
         std::optional<double> focal_35mm, double min_confidence, const std::string& convention,
         const std::optional<Path>& body, std::optional<double> stature_m, const std::optional<Path>& prior,
         const std::optional<Path>& lifter, const std::string& solver, int threads, int max_iterations,
         bool estimate_shape, bool uncertainty, bool ground, const py::object& progress) {
        TrackViewsRequest request;
        request.views = views;
        request.known = KnownOfRigFromString(known);
        request.same_lens = same_lens;
        std::tie(request.image_width, request.image_height) = image_size.value_or(std::pair(0, 0));
        BODYLOOM_CHECK(!image_size || (request.image_width > 0 && request.image_height > 0),
                       "image_size: expected pixels above 0, found (", request.image_width, ", ", request.image_height,
                       ")");
        request.fps = PositiveOr0(fps, "fps");
        request.focal_px = PositiveOr0(focal_px, "focal_px");
        request.focal_35mm_mm = PositiveOr0(focal_35mm, "focal_35mm");
        request.min_confidence = min_confidence;
        request.convention = convention;
        request.body = TextOf(body);
        request.stature_m = PositiveOr0(stature_m, "stature_m");
        request.prior = TextOf(prior);
        request.lifter = TextOf(lifter);
        TrackSequenceOptions& solve = request.solve;
        solve.solver = SequenceSolverFromString(solver);
        solve.num_threads = threads;
        solve.max_iterations = max_iterations;
        solve.estimate_shape = estimate_shape;
        solve.estimate_uncertainty = uncertainty;
        if (!ground) solve.ground = GroundOptions::Off();
        const auto* one = std::get_if<Path>(&keypoints);
        return RunTrackViews(
            std::move(request),
            one != nullptr ? std::vector<ViewArgument>{*one} : std::get<std::vector<ViewArgument>>(keypoints), cameras,
            progress);
      },
      py::arg("keypoints"), py::kw_only(), py::arg("views") = std::vector<std::string>(),
      py::arg("cameras") = py::none(), py::arg("known") = ToString(defaults.known), py::arg("same_lens") = false,
      py::arg("image_size") = py::none(), py::arg("fps") = py::none(), py::arg("focal_px") = py::none(),
      py::arg("focal_35mm") = py::none(), py::arg("min_confidence") = 0.0, py::arg("convention") = "",
      py::arg("body") = py::none(), py::arg("stature_m") = py::none(), py::arg("prior") = py::none(),
      py::arg("lifter") = py::none(), py::arg("solver") = ToString(defaults.solve.solver),
      py::arg("threads") = defaults.solve.num_threads, py::arg("max_iterations") = defaults.solve.max_iterations,
      py::arg("estimate_shape") = true, py::arg("uncertainty") = true, py::arg("ground") = true,
      py::arg("progress") = py::none(), kTrackViewsDoc);
}

}  // namespace bodyloom::python
