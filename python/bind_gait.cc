// SPDX-License-Identifier: Apache-2.0
// Joint angles and gait. docs/python.md.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "data_tools/export/angle_writers.h"
#include "geometry/base/check.h"
#include "geometry/biomechanics/gait.h"
#include "geometry/biomechanics/track_angles.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/track_object.h"
#include "render/view/floor.h"
#include "render/view/follow_view.h"

namespace bodyloom::python {
namespace {

constexpr const char* kJointAnglesDoc = R"(Joint angles of a track by OpenSim's names (docs/exports.md, "Joint angles").

T frames of C coordinates: degrees, but metres for pelvis_tx, _ty and _tz. angles["knee_angle_r"] is one column.)";

constexpr const char* kJointAnglesFunctionDoc = R"(Clinical joint angles of every frame, in the clip's world.

body          Body that the track is of, or a file; None: the track's own
pelvis_order  "rotation-first": a turn about the vertical changes pelvis_rotation alone; "tilt-first": as in OpenSim's
              models and files

Returns JointAngles; frames that are lost are NaN. Raises ValueError for a body without the joints, RuntimeError for a
file that cannot be used.)";

constexpr const char* kGaitDoc = R"(Steps and figures of gait, where the person walks.

Returns a dict, the JSON that export(..., "angles", events=...) writes: "walks", "reason" (where nobody walks),
"num_steps", "cadence_per_min", "step_time_s", "step_length_m" {"left", "right"}, "speed_mps", "bouts_s" and "events", a
list of {"time_s", "frame", "foot", "event"}. Raises as joint_angles().)";

WorldFrame WorldOfTrack(const BodyModel& body, const TrackObject& track) {
  RequireTrackFitsBody(track.track, body, track.name);
  return WorldOfTracks({&track.track}, TrackJoints(body, track.track));
}

PelvisOrder PelvisOrderFromText(const std::string& text) {
  BODYLOOM_CHECK(text == "rotation-first" || text == "tilt-first", "pelvis_order: '", text,
                 "', expected \"rotation-first\" or \"tilt-first\"");
  return text == "tilt-first" ? PelvisOrder::kTiltFirst : PelvisOrder::kRotationFirst;
}

TrackAngles JointAnglesFromPython(const TrackArgument& track_argument, const std::optional<BodyArgument>& body,
                                  const std::string& pelvis_order) {
  const std::shared_ptr<TrackObject> track = TrackFrom(track_argument);
  const std::shared_ptr<const BodyModel> model = BodyOf(*track, body);
  return AnglesOfTrack(*model, track->track, WorldOfTrack(*model, *track), PelvisOrderFromText(pelvis_order));
}

py::object GaitFromPython(const TrackArgument& track_argument, const std::optional<BodyArgument>& body) {
  const std::shared_ptr<TrackObject> track = TrackFrom(track_argument);
  const std::shared_ptr<const BodyModel> model = BodyOf(*track, body);
  const GaitReport gait = AnalyseGait(*model, track->track, WorldOfTrack(*model, *track));
  return py::module_::import("json").attr("loads")(GaitJson(gait));
}

py::array ColumnOf(const py::object& self, const std::string& name) {
  const int column = FindCoordinate(name);
  if (column < 0) throw py::key_error(name);
  const RowMatrixXd& values = self.cast<const TrackAngles&>().values;
  return View(values.data() + column, {values.rows()}, {py::ssize_t(sizeof(double)) * values.cols()}, self);
}

}  // namespace

void BindGait(py::module_& module) {
  py::class_<TrackAngles>(module, "JointAngles", kJointAnglesDoc)
      .def_property_readonly(
          "names", [](const TrackAngles&) { return CoordinateNames(); }, "The C names.")
      .def_property_readonly(
          "timestamps",
          [](const py::object& self) {
            const std::vector<double>& times = self.cast<const TrackAngles&>().timestamps;
            return View(times.data(), {py::ssize_t(times.size())}, self);
          },
          "(T,) float64 view, seconds.")
      .def_property_readonly(
          "values", [](const py::object& self) { return MatrixView(self.cast<const TrackAngles&>().values, self); },
          "(T, C) float64 view: degrees, metres for pelvis_t*; NaN where a frame is lost.")
      .def_property_readonly(
          "sigma_deg",
          [](const py::object& self) { return MatrixView(self.cast<const TrackAngles&>().sigma_deg, self); },
          "(T, C) float64 view: standard deviations, degrees; NaN where the track's joint_sigma determine none.")
      .def("__getitem__", &ColumnOf, py::arg("name"));
  module.def("joint_angles", &JointAnglesFromPython, py::arg("track"), py::kw_only(), py::arg("body") = py::none(),
             py::arg("pelvis_order") = "rotation-first", kJointAnglesFunctionDoc);
  module.def("gait", &GaitFromPython, py::arg("track"), py::kw_only(), py::arg("body") = py::none(), kGaitDoc);
}

}  // namespace bodyloom::python
