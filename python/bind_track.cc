// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "data_tools/motion/track_io.h"
#include "geometry/base/check.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/track_object.h"

namespace bodyloom::python {
namespace {

constexpr const char* kTrackDoc = R"(A body in every frame of a clip, with the camera that saw it.

T frames of a body with J joints; metres, camera frame (x right, y down, z forward), radians, seconds. Frames that are
lost are NaN. Tracks do not change; arrays are views of one memory that lives as long as any of them.
track() makes one, Track.load() reads one, Track.from_arrays() takes arrays.)";

constexpr const char* kTrackLoadDoc = R"(The track in a .npz that this project or an AMASS writer made.

Raises RuntimeError naming file, member, what it holds and what was expected.)";

constexpr const char* kFromArraysDoc =
    R"(A track of arrays under the names of the track file (data_tools/motion/track_io.h).

Needed are poses (T, 3J), trans (T, 3) and a camera: K (3, 3), or camera (T, 3) of weak perspective; also taken are
betas, timestamps (or mocap_framerate), body, frame_status, joints, coco17, joint_sigma, root_sigma, distortion, image_size,
world_from_camera, world_level. Track.to_arrays() gives them all, so that
Track.from_arrays(**{**track.to_arrays(), "trans": moved}) is the track with one array changed; joints and coco17 stay as they are given.
Raises ValueError naming the array, what it holds and what was expected.)";

const Track& TrackOf(const py::object& self) { return self.cast<const TrackObject&>().track; }

/// (T, n, 3); n is 0 when the track has none.
py::array PointsView(const py::object& self, const std::vector<double>& points) {
  const py::ssize_t T = TrackOf(self).num_frames();
  return View(points.data(), {T, py::ssize_t(points.size()) / (3 * T), 3}, self);
}

py::array StatusView(const py::object& self) {
  static_assert(sizeof(FrameStatus) == 1, "statuses are seen as bytes");
  const std::vector<FrameStatus>& status = TrackOf(self).frame_status;
  return View(reinterpret_cast<const uint8_t*>(status.data()), {py::ssize_t(status.size())}, self);
}

py::array TimestampsView(const py::object& self) {
  const std::vector<double>& times = TrackOf(self).motion.timestamps;
  return View(times.data(), {py::ssize_t(times.size())}, self);
}

py::object WorldOf(const TrackObject& self) {
  if (!self.track.world) return py::none();
  Eigen::Matrix<double, 4, 4, Eigen::RowMajor> world = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>::Identity();
  world.topLeftCorner<3, 3>() = self.track.world->rotation;
  world.topRightCorner<3, 1>() = self.track.world->translation;
  return py::array_t<double>({4, 4}, world.data());
}

py::dict ArraysOf(const py::object& self) {
  const auto& object = self.cast<const TrackObject&>();
  const Track& track = object.track;
  py::dict arrays;
  for (const char* name : {"poses", "trans", "betas", "timestamps", "frame_status", "joint_sigma"}) {
    arrays[name] = self.attr(name);
  }
  if (track.root_sigma.size() > 0) arrays["root_sigma"] = self.attr("root_sigma");
  if (!object.joints.empty()) arrays["joints"] = self.attr("joints");
  if (!object.coco17.empty()) arrays["coco17"] = self.attr("coco17");
  arrays["body"] = track.motion.body;
  arrays["camera_model"] = ToString(track.camera.model);
  const py::object camera = self.attr("camera");
  arrays["K"] = camera.attr("K");
  arrays["distortion"] = camera.attr("distortion");
  const int size[] = {track.camera.width, track.camera.height};
  arrays["image_size"] = py::array_t<int>(2, size);
  if (track.weak_camera.rows() > 0) arrays["camera"] = MatrixView(track.weak_camera, self);
  if (track.world) {
    arrays["world_from_camera"] = WorldOf(object);
    arrays["world_source"] = ToString(track.world->source);
    const double sigma[] = {track.world->vertical_sigma_deg, track.world->height_sigma_m};
    arrays["world_sigma"] = py::array_t<double>(2, sigma);
  }
  if (track.level_m.size() > 0) arrays["world_level"] = self.attr("world_level");
  return arrays;
}

std::shared_ptr<TrackObject> TrackFromKeywords(const py::kwargs& arrays) {
  const py::object buffer = py::module_::import("io").attr("BytesIO")();
  py::module_::import("numpy").attr("savez")(buffer, **arrays);
  const auto bytes = buffer.attr("getvalue")().cast<std::string>();
  try {
    return std::make_shared<TrackObject>(ReadTrackBytes(bytes, "arrays"), "arrays");
  } catch (const std::runtime_error& error) {  // what is refused in a file is here an argument
    throw std::invalid_argument(error.what());
  }
}

std::string TrackText(const TrackObject& self) {
  return Concatenate("Track(", self.name, ", ", self.track.num_frames(), " frames of body '", self.track.motion.body,
                     "')");
}

py::dict SecondsOf(const TrackSequenceSummary& summary) {
  py::dict seconds;
  for (const auto& [stage, time] : summary.seconds) seconds[py::str(stage)] = time;
  return seconds;
}

py::dict CostsOf(const TrackSequenceSummary& summary) {
  py::dict costs;
  for (const TermCost& cost : summary.costs) costs[py::str(cost.term)] = cost.cost;
  return costs;
}

py::list PlanOf(const TrackSequenceSummary& summary) {
  py::list plan;
  for (const PlanEntry& entry : summary.plan) plan.append(py::make_tuple(entry.what, entry.runs, entry.why));
  return plan;
}

void BindTrackSummary(py::module_& module) {
  using Summary = TrackSequenceSummary;
  py::class_<Summary>(module, "TrackSummary", "How a solve went. str() gives a few lines for a reader.")
      .def_property_readonly(
          "status", [](const Summary& self) { return ToString(self.status); }, "How the solve ended.")
      .def_readonly("message", &Summary::message)
      .def_readonly("solver", &Summary::solver, "\"chain+ceres\", \"chain\" or \"ceres\".")
      .def_readonly("iterations", &Summary::iterations)
      .def_readonly("initial_cost", &Summary::initial_cost)
      .def_readonly("final_cost", &Summary::final_cost)
      .def_readonly("num_observations", &Summary::num_observations)
      .def_readonly("frames_by_status", &Summary::frames_by_status,
                    "Frames that are \"tracked\", \"weak\", \"interpolated\", \"lost\".")
      .def_readonly("reprojection_median_px", &Summary::reprojection_median_px,
                    "Of the 2D joints that were used, pixels.")
      .def_readonly("reprojection_p95_px", &Summary::reprojection_p95_px)
      .def_readonly("dense_median_px", &Summary::dense_median_px, "Of the dense keypoints, pixels; 0 without.")
      .def_property_readonly(
          "frame_px",
          [](const py::object& self) {
            const std::vector<double>& px = self.cast<const Summary&>().frame_px;
            return View(px.data(), {py::ssize_t(px.size())}, self);
          },
          "(T,) float64 view: median error of the 2D joints in each frame, pixels; NaN where none was used. Empty "
          "for a live track.")
      .def_readonly("focal_px", &Summary::focal_px, "Used or estimated, pixels.")
      .def_readonly("focal_log_sigma", &Summary::focal_log_sigma,
                    "Standard deviation of the logarithm of an estimated focal length; 0: it was known, NaN: unknown.")
      .def_readonly("stature_m", &Summary::stature_m, "That was given; 0: the mean body's.")
      .def_readonly("num_swaps_repaired", &Summary::num_swaps_repaired,
                    "Left and right joints that were exchanged in the detections.")
      .def_property_readonly("seconds", &SecondsOf, "By stage, in the order of running.")
      .def_property_readonly("cost_by_term", &CostsOf, "What each term costs at the answer; the sum is final_cost.")
      .def_property_readonly("plan", &PlanOf, "What ran and what was skipped: (what, runs, why).")
      .def("__str__", &Summary::BriefReport);
}

}  // namespace

void BindTrack(py::module_& module) {
  BindTrackSummary(module);
  module.attr("FRAME_STATUS") = py::make_tuple(ToString(FrameStatus::kTracked), ToString(FrameStatus::kWeak),
                                               ToString(FrameStatus::kInterpolated), ToString(FrameStatus::kLost));
  py::class_<TrackObject, std::shared_ptr<TrackObject>>(module, "Track", kTrackDoc)
      .def_static(
          "load", [](const Path& path) { return TrackFrom(TrackArgument(path)); }, py::arg("path"), kTrackLoadDoc)
      .def_static("from_arrays", &TrackFromKeywords, kFromArraysDoc)
      .def("to_arrays", &ArraysOf, "A dict of the track file's arrays, views where that is possible.")
      .def(
          "save", [](const TrackObject& self, const Path& path) { WriteTrack(path.string(), self.track); },
          py::arg("path"), py::call_guard<py::gil_scoped_release>(),
          "Writes the .npz, whole or not at all: the same bytes as the command's. Raises RuntimeError naming the file.")
      .def_property_readonly(
          "poses", [](const py::object& self) { return MatrixView(TrackOf(self).motion.poses, self); },
          "(T, 3J) float64 view: axis-angle of every joint relative to its parent, radians.")
      .def_property_readonly(
          "trans", [](const py::object& self) { return MatrixView(TrackOf(self).motion.trans, self); },
          "(T, 3) float64 view, metres.")
      .def_property_readonly(
          "betas", [](const py::object& self) { return MatrixView(TrackOf(self).motion.betas, self); },
          "(B,) float64 view: the shape, one for the clip.")
      .def_property_readonly("timestamps", &TimestampsView, "(T,) float64 view, seconds.")
      .def_property_readonly("frame_status", &StatusView,
                             "(T,) uint8 view: index into FRAME_STATUS (tracked, weak, interpolated, lost).")
      .def_property_readonly(
          "joints", [](const py::object& self) { return PointsView(self, self.cast<const TrackObject&>().joints); },
          "(T, J, 3) float64 view, metres; (T, 0, 3) when the file has none.")
      .def_property_readonly(
          "coco17", [](const py::object& self) { return PointsView(self, self.cast<const TrackObject&>().coco17); },
          "(T, 17, 3) float64 view of COCO's landmarks, metres; (T, 0, 3) for bodies without them.")
      .def_property_readonly(
          "joint_sigma", [](const py::object& self) { return MatrixView(TrackOf(self).joint_sigma, self); },
          "(T, J) float64 view: standard deviation of each joint's position about the mid-hip, metres; NaN: unknown.")
      .def_property_readonly(
          "root_sigma", [](const py::object& self) { return MatrixView(TrackOf(self).root_sigma, self); },
          "(T,) float64 view: standard deviation of the mid-hip's own position, metres; (0,) when the file has none.")
      .def_property_readonly(
          "camera", [](const TrackObject& self) { return self.track.camera; }, "The intrinsics of all frames.")
      .def(
          "camera_at", [](const TrackObject& self, int frame) { return self.track.CameraAt(frame); }, py::arg("frame"),
          "The camera of one frame: differs from `camera` for weak perspective alone.")
      .def_property_readonly("world_from_camera", &WorldOf,
                             "(4, 4) float64: camera frame to the clip's world (y up, ground at y = 0), metres; None "
                             "when the track does not say.")
      .def_property_readonly(
          "world_source",
          [](const TrackObject& self) { return self.track.world ? ToString(self.track.world->source) : ""; },
          "How the world was found; \"\" when the track does not say.")
      .def_property_readonly(
          "world_level", [](const py::object& self) { return MatrixView(TrackOf(self).level_m, self); },
          "(T,) float64 view: height of the level that supports the person over the world's ground, metres; (0,): the "
          "ground alone.")
      .def_property_readonly(
          "body", [](const TrackObject& self) { return self.track.motion.body; }, "Name of the body's family.")
      .def_property_readonly(
          "summary",
          [](const py::object& self) -> py::object {
            const auto& summary = self.cast<const TrackObject&>().summary;
            if (!summary) return py::none();
            return py::cast(&*summary, py::return_value_policy::reference_internal, self);
          },
          "How the solve went; None for a track that was read.")
      .def("__len__", [](const TrackObject& self) { return self.track.num_frames(); })
      .def("__repr__", &TrackText)
      .def(py::pickle([](const py::object& self) { return ArraysOf(self); },
                      [](const py::dict& arrays) { return TrackFromKeywords(py::kwargs(arrays)); }));
}

}  // namespace bodyloom::python
