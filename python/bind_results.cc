// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/base/check.h"
#include "pipelines/export/export_track.h"
#include "pipelines/score/evaluate_track.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/python_callbacks.h"
#include "python/track_object.h"

namespace bodyloom::python {
namespace {

constexpr const char* kEvaluateDoc = R"(A track against what is known: errors by name, with units in the name.

truth     a Track, a track or part labels (.npz), a sequence of EMDB, 3DPW, RICH or Human3.6M, an AIST++ folder or a
          Pose2Sim folder; None: the track alone
body      Body that both were made with, or a file; None: the track's own
true_body, true_person   EMDB, 3DPW, RICH: file of the true motion's body; which of the people
joint_regressor          J_regressor_h36m.npy: Human3.6M's joints of the vertices
cameras   AIST++: camera folder, RICH and Human3.6M: the calibration; sequence: name of the clip; view: the camera that
          the track was fitted to
rig       RigCameras or a rig.json of a truth that is the track of several cameras (track_views()); `view`: the one
          that this track was fitted to ("": the first); equal_clocks: cameras whose clock is not known ran on the
          first one's

With or without a truth, a track that states a world is measured in it: "hover_percent", "ground_penetration_p95_mm",
"balance_outside_percent", "lean_median_deg", ... (docs/evaluation.md).

Returns an Evaluation. Raises ValueError for arguments that do not go together, RuntimeError naming a file that cannot
be used.)";

constexpr const char* kEvaluationDoc =
    R"(The result of an evaluation: evaluation["pa_mpjpe_mm"]; str() gives the table.)";

constexpr const char* kExportDoc = R"(Writes a track for another program, whole or not at all.

tracks      a Track or a file; a list of them, people of one clip, for "glb", "fbx" and "colmap"
out         the file, or for "obj" of all frames and "colmap" the folder
form        "vertices", "joints" (.npy), "obj", "amass", "bvh", "glb", "fbx", "smplx", "trc", "c3d", "colmap",
            "pose2sim", "angles"
body        Body that the tracks are of, or a file; None: the first track's own
world_axes  of vertices, joints and obj: the clip's world (y up, ground at y = 0) instead of the camera frame
frame       of obj: only this frame
rig         of bvh, fbx: names and rest pose: "smpl", "mixamo", "unreal", "vrm"
textures    of glb, fbx: PNG files, one a track
correctives of glb, fbx: shapes for pose correctives, 0 to 64
events      of angles: a .json for the events of gait; None: not written
docs/exports.md says what each form holds. Returns a few lines of text on what was written. Raises ValueError for
arguments that do not go together, RuntimeError naming a file that cannot be used or a frame that is lost.)";

py::dict ValuesOf(const Evaluation& evaluation) {
  py::dict values;
  for (const EvaluationValue& value : evaluation.values) values[py::str(value.name)] = value.value;
  return values;
}

py::dict MeaningsOf(const Evaluation& evaluation) {
  py::dict meanings;
  for (const EvaluationValue& value : evaluation.values) meanings[py::str(value.name)] = value.meaning;
  return meanings;
}

py::dict BreakdownsOf(const Evaluation& evaluation) {
  py::dict breakdowns;
  for (const EvaluationBreakdown& breakdown : evaluation.breakdowns) {
    py::dict values;
    for (size_t i = 0; i < breakdown.labels.size(); ++i) values[py::str(breakdown.labels[i])] = breakdown.values[i];
    breakdowns[py::str(breakdown.name)] = values;
  }
  return breakdowns;
}

double ValueOf(const Evaluation& evaluation, const std::string& name) {
  for (const EvaluationValue& value : evaluation.values) {
    if (value.name == name) return value.value;
  }
  throw py::key_error(name);
}

Evaluation EvaluateFromPython(const TrackArgument& track_argument, const std::optional<TrackArgument>& truth,
                              const std::optional<BodyArgument>& body, const std::optional<Path>& true_body,
                              int true_person, const std::optional<Path>& joint_regressor,
                              const std::optional<Path>& cameras, const std::string& sequence, const std::string& view,
                              const std::optional<RigArgument>& rig, bool equal_clocks, const py::object& progress) {
  const std::shared_ptr<TrackObject> track = TrackFrom(track_argument);
  const std::shared_ptr<const BodyModel> body_model = BodyOf(*track, body);
  EvaluateTrackRequest request;
  request.track = track->name;
  request.true_body = TextOf(true_body);
  request.true_person = true_person;
  request.joint_regressor = TextOf(joint_regressor);
  request.cameras = TextOf(cameras);
  request.sequence = sequence;
  request.view = view;
  request.equal_clocks = equal_clocks;
  EvaluationInMemory given;
  if (rig) {
    given.rig = std::get_if<std::vector<RigCamera>>(&*rig);
    if (given.rig == nullptr) request.rig = std::get<Path>(*rig).string();
  }
  std::shared_ptr<TrackObject> true_track;
  if (truth) {
    if (const auto* in_memory = std::get_if<std::shared_ptr<TrackObject>>(&*truth)) {
      true_track = *in_memory;
      given.truth = &true_track->track;
    } else {
      request.truth = std::get<Path>(*truth).string();
    }
  }
  return PythonCallbacks(progress).Run([&](const PipelineCallbacks& callbacks) {
    return EvaluateTrack(request, *body_model, track->track, given, callbacks);
  });
}

std::string ExportFromPython(const std::variant<TrackArgument, std::vector<TrackArgument>>& tracks, const Path& out,
                             const std::string& form, const std::optional<BodyArgument>& body, bool world_axes,
                             std::optional<int> frame, const std::string& rig, const std::vector<Path>& textures,
                             int correctives, const std::optional<Path>& events, const py::object& progress) {
  std::vector<std::shared_ptr<TrackObject>> each;
  if (const auto* one = std::get_if<TrackArgument>(&tracks)) {
    each.push_back(TrackFrom(*one));
  } else {
    for (const TrackArgument& track : std::get<std::vector<TrackArgument>>(tracks)) each.push_back(TrackFrom(track));
  }
  BODYLOOM_CHECK(!each.empty(), "tracks: expected at least one, found none");
  BODYLOOM_CHECK(!frame || *frame >= 0, "frame: expected 0 or more, found ", *frame);
  ExportTrackRequest request;
  std::vector<const Track*> borrowed;
  for (const std::shared_ptr<TrackObject>& track : each) {
    request.tracks.push_back(track->name);
    borrowed.push_back(&track->track);
  }
  request.form = TrackFormFromString(form);
  request.world_axes = world_axes;
  request.frame = frame.value_or(-1);
  request.rig = AnimationRigFromString(rig);
  for (const Path& texture : textures) request.textures.push_back(texture.string());
  request.correctives = correctives;
  request.events = TextOf(events);
  request.out = out.string();
  const std::shared_ptr<const BodyModel> body_model = BodyOf(*each.front(), body);
  return PythonCallbacks(progress).Run([&](const PipelineCallbacks& callbacks) {
    return ToText(ExportTrack(request, *body_model, borrowed, callbacks));
  });
}

}  // namespace

void BindResults(py::module_& module) {
  py::class_<Evaluation>(module, "Evaluation", kEvaluationDoc)
      .def_readonly("protocol", &Evaluation::protocol, "Its short name.")
      .def_readonly("description", &Evaluation::description,
                    "What is compared with what, after which alignment, over which frames.")
      .def_readonly("frames", &Evaluation::frames, "Compared.")
      .def_readonly("frames_without_result", &Evaluation::frames_without_result,
                    "Of these, scored with the nearest frame that has one.")
      .def_property_readonly("values", &ValuesOf, "Numbers by name; NaN: there was nothing to measure.")
      .def_property_readonly("meanings", &MeaningsOf, "What each number means, one line each.")
      .def_property_readonly("breakdowns", &BreakdownsOf, "By name, numbers by joint or camera.")
      .def("__getitem__", &ValueOf, py::arg("name"))
      .def("__str__", &EvaluationTable);
  const ExportTrackRequest defaults;
  module.def("evaluate", &EvaluateFromPython, py::arg("track"), py::arg("truth") = py::none(), py::kw_only(),
             py::arg("body") = py::none(), py::arg("true_body") = py::none(), py::arg("true_person") = 0,
             py::arg("joint_regressor") = py::none(), py::arg("cameras") = py::none(), py::arg("sequence") = "",
             py::arg("view") = "", py::arg("rig") = py::none(), py::arg("equal_clocks") = false,
             py::arg("progress") = py::none(), kEvaluateDoc);
  module.def("export", &ExportFromPython, py::arg("tracks"), py::arg("out"), py::arg("form"), py::kw_only(),
             py::arg("body") = py::none(), py::arg("world_axes") = false, py::arg("frame") = py::none(),
             py::arg("rig") = AnimationRigNames()[size_t(defaults.rig)], py::arg("textures") = std::vector<Path>(),
             py::arg("correctives") = defaults.correctives, py::arg("events") = py::none(),
             py::arg("progress") = py::none(), kExportDoc);
}

}  // namespace bodyloom::python
