// SPDX-License-Identifier: Apache-2.0
#include "pipelines/export/export_track.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <utility>

#include "data_tools/export/angle_writers.h"
#include "data_tools/export/camera_writers.h"
#include "data_tools/export/export_scene.h"
#include "data_tools/export/fbx_writer.h"
#include "data_tools/export/glb_writer.h"
#include "data_tools/export/markers.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/npz.h"
#include "data_tools/motion/amass.h"
#include "data_tools/motion/bvh_writer.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/motion/track_io.h"
#include "geometry/base/check.h"
#include "geometry/base/stopwatch.h"
#include "geometry/biomechanics/track_angles.h"
#include "geometry/body/hand_skeleton.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/track_edits.h"
#include "pipelines/body_of_track.h"
#include "pipelines/files.h"
#include "render/view/floor.h"
#include "render/view/follow_view.h"
#include "render/view/overlay.h"

namespace bodyloom {
namespace {

// Exports the joint angles of a track, and the events of gait.

/// "angles are written to .csv or .mot (OpenSim), found …" for a path of another extension; "" for these.
std::string AnglesPathFault(const std::string& out) {
  const std::string extension = LowerExtension(out);
  if (extension == ".csv" || extension == ".mot") return "";
  return "angles are written to .csv or .mot (OpenSim), found " + out;
}

/// Writes the angles as CSV (the pelvis' rotation first) or, to a path that ends in .mot, for OpenSim (its tilt first,
/// data_tools/export/angle_writers.h), the gait as JSON to `events` if that is not empty, and returns the gait. Throws
/// std::invalid_argument for a body without the joints, and of .mot when every frame is lost.
GaitReport ExportAngles(const BodyModel& body, const Track& track, const WorldFrame& world, const std::string& out,
                        const std::string& events) {
  const bool mot = LowerExtension(out) == ".mot";
  const TrackAngles angles =
      AnglesOfTrack(body, track, world, mot ? PelvisOrder::kTiltFirst : PelvisOrder::kRotationFirst);
  GaitReport gait = AnalyseGait(body, track, world);
  WriteFileAtomically(out, mot ? AnglesMot(angles) : AnglesCsv(angles));
  if (!events.empty()) WriteFileAtomically(events, GaitJson(gait));
  return gait;
}

constexpr int kBodyJointsOfSmpl = 22;

std::string ObjText(const MatrixX3d& vertices, const BodyModelData& body) {
  std::string text;
  char line[128];
  for (int v = 0; v < vertices.rows(); ++v) {
    std::snprintf(line, sizeof line, "v %.6f %.6f %.6f\n", vertices(v, 0), vertices(v, 1), vertices(v, 2));
    text += line;
  }
  for (int u = 0; u < body.vt.rows(); ++u) {
    std::snprintf(line, sizeof line, "vt %.6f %.6f\n", body.vt(u, 0), body.vt(u, 1));
    text += line;
  }
  const bool has_uv = body.ft.rows() == body.faces.rows();
  for (int f = 0; f < body.faces.rows(); ++f) {
    text += "f";
    for (int k = 0; k < 3; ++k) {
      text += " " + std::to_string(body.faces(f, k) + 1);
      if (has_uv) {
        text += "/" + std::to_string(body.ft(f, k) + 1);
      }
    }
    text += "\n";
  }
  return text;
}

/// Inputs of an export; borrowed.
struct ExportInputs {
  const BodyModel* body = nullptr;
  std::vector<const Track*> tracks;
  WorldFrame world;
  [[nodiscard]] const Track& track() const { return *tracks.front(); }
  [[nodiscard]] Motion MotionOfTrack() const {
    return MotionInWorld(world, body->RestJoints(track().motion.betas).row(0).transpose(), track().motion);
  }
  [[nodiscard]] ExportScene Scene() const {
    const std::vector<const BodyModel*> bodies(tracks.size(), body);
    return MakeExportScene(bodies, tracks, world);
  }
};

/// In the axes of the request; no rows where a frame is lost.
MatrixX3d VerticesOf(const ExportInputs& inputs, const ExportTrackRequest& request, int t) {
  MatrixX3d vertices = TrackVertices(*inputs.body, inputs.track(), t);
  return request.world_axes && vertices.rows() > 0 ? inputs.world.PointsFromCamera(vertices) : vertices;
}

void ExportVertices(const ExportInputs& inputs, const ExportTrackRequest& request, const PipelineCallbacks& callbacks) {
  const int T = inputs.track().num_frames(), V = inputs.body->num_vertices();
  const size_t row = 3 * static_cast<size_t>(V);
  std::vector<float> values(row * T, std::nanf(""));
  for (int t = 0; t < T; ++t) {
    callbacks.Update("export", static_cast<double>(t) / T);
    const MatrixX3d vertices = VerticesOf(inputs, request, t);
    if (vertices.rows() > 0) Eigen::Map<MatrixX3f>(values.data() + row * t, V, 3) = vertices.cast<float>();
  }
  WriteNpy(request.out, NdArray::FromFloats(values.data(), {T, V, 3}));
}

void ExportJoints(const ExportInputs& inputs, const ExportTrackRequest& request) {
  const Track& track = inputs.track();
  const auto num_joints = track.joints.empty() ? 0 : track.joints[0].rows();
  RowMatrixXd values(track.num_frames(), 3 * num_joints);
  for (int t = 0; t < track.num_frames(); ++t) {
    const MatrixX3d joints = request.world_axes ? inputs.world.PointsFromCamera(track.joints[t]) : track.joints[t];
    values.row(t) = Eigen::Map<const Eigen::RowVectorXd>(joints.data(), 3 * num_joints);
  }
  WriteNpy(request.out, NdArray::FromDoubles(values.data(), {track.num_frames(), num_joints, 3}));
}

void ExportObj(const ExportInputs& inputs, const ExportTrackRequest& request, const PipelineCallbacks& callbacks) {
  const BodyModelData& body = inputs.body->data();
  if (request.frame >= 0) {
    const MatrixX3d vertices = VerticesOf(inputs, request, request.frame);
    if (vertices.rows() == 0) {
      throw std::runtime_error(
          Concatenate(request.tracks[0], ": frame ", request.frame, " is lost, there is no body to write"));
    }
    WriteFileAtomically(request.out, ObjText(vertices, body));
    return;
  }
  const int T = inputs.track().num_frames();
  for (int t = 0; t < T; ++t) {
    callbacks.Update("export", static_cast<double>(t) / T);
    const MatrixX3d vertices = VerticesOf(inputs, request, t);
    if (vertices.rows() > 0) {
      char name[32];
      std::snprintf(name, sizeof name, "frame_%06d.obj", t);
      WriteFileAtomically((std::filesystem::path(request.out) / name).string(), ObjText(vertices, body));
    }
  }
}

bool IsFolder(const ExportTrackRequest& request) {
  return (request.form == TrackForm::kObj && request.frame < 0) || request.form == TrackForm::kColmap;
}

bool HasSkins(TrackForm form) { return form == TrackForm::kGlb || form == TrackForm::kFbx; }

bool TakesPeople(TrackForm form) { return HasSkins(form) || form == TrackForm::kColmap; }

bool HasAxes(TrackForm form) {
  return form == TrackForm::kVertices || form == TrackForm::kJoints || form == TrackForm::kObj;
}

void CheckExportOptions(const ExportTrackRequest& request) {
  const std::string& form = TrackFormNames()[size_t(request.form)];
  if (request.tracks.empty()) throw RequestError("--track is required: the track to write");
  if (request.tracks.size() > 1 && !TakesPeople(request.form)) {
    throw RequestError(
        Concatenate(request.tracks.size(), " tracks: ", form, " holds one person, expected one --track"));
  }
  if (request.world_axes && !HasAxes(request.form)) {
    throw RequestError("--axes is of vertices, joints and obj: " + form + " has axes of its own");
  }
  if (request.rig != AnimationRig::kSmpl && request.form != TrackForm::kBvh && request.form != TrackForm::kFbx)
    throw RequestError("--rig is of bvh and fbx, not of " + form);
  if (!request.textures.empty() && !HasSkins(request.form)) {
    throw RequestError("--texture is of glb and fbx, not of " + form);
  }
  if (request.textures.size() > request.tracks.size()) {
    throw RequestError(Concatenate(request.textures.size(), " textures for ", request.tracks.size(), " tracks"));
  }
  const bool angles = request.form == TrackForm::kAngles;
  if (!request.events.empty() && !angles) throw RequestError("--events is of angles, not of " + form);
  if (angles && !AnglesPathFault(request.out).empty()) throw RequestError(AnglesPathFault(request.out));
}

/// Files beside the tracks and the body.
void CheckOtherFilesOf(const ExportTrackRequest& request) {
  for (const std::string& texture : request.textures) RequireReadable(texture, "texture");
  RequireDistinct(request.textures, {request.out});
  RequireDistinct({}, {request.out, request.events});
  RequireWritable(request.events);
  if (IsFolder(request)) {
    RequireWritableFolder(request.out);
  } else {
    RequireWritable(request.out);
  }
}

ExportInputs CheckedInputs(const ExportTrackRequest& request, const BodyModel& body,
                           const std::vector<const Track*>& tracks) {
  ExportInputs inputs;
  inputs.body = &body;
  inputs.tracks = tracks;
  std::vector<MatrixX3d> joints;
  for (size_t i = 0; i < tracks.size(); ++i) {
    const std::string& name = request.tracks[i];
    if (request.frame >= tracks[i]->num_frames()) {
      throw std::runtime_error(
          Concatenate(name, ": ", tracks[i]->num_frames(), " frames, expected one with number ", request.frame));
    }
    RequireTrackFitsBody(*tracks[i], body, name);
    const std::vector<MatrixX3d> own = TrackJoints(body, *tracks[i]);
    joints.insert(joints.end(), own.begin(), own.end());
  }
  inputs.world = WorldOfTracks(tracks, joints);
  return inputs;
}

/// BVH and AMASS have a pose in every frame: frames before the first sight and after the last are left out, and those
/// that are lost between them are interpolated.
Motion MotionOfEveryFrame(const ExportInputs& inputs, const ExportTrackRequest& request, ExportTrackReport* report) {
  const Motion motion = inputs.MotionOfTrack();
  const auto [begin, end] = PosedSpan(motion);
  if (begin == end) throw std::runtime_error(request.tracks[0] + ": every frame is lost, there is nothing to write");
  report->lost_before = begin;
  report->lost_after = motion.num_frames() - end;
  Motion filled = FramesOfMotion(motion, begin, end);
  const std::vector<double>& times = filled.timestamps;
  for (int t = 1, before = 0; t < filled.num_frames(); ++t) {
    if (!filled.HasPose(t)) continue;
    for (int lost = before + 1; lost < t; ++lost, ++report->lost_between) {
      const double share = (times[lost] - times[before]) / (times[t] - times[before]);
      InterpolateFrame(filled, before, t, share, lost, &filled);
    }
    before = t;
  }
  return filled;
}

/// The same for AMASS, whose hands count from the flat ones of the template: the body's mean hand is added, and poses
/// of 24 joints become those of its fingers.
Motion MotionWithHands(const ExportInputs& inputs, const ExportTrackRequest& request, ExportTrackReport* report) {
  Motion motion = MotionOfEveryFrame(inputs, request, report);
  const BodyModel& body = *inputs.body;
  if (!HasFingers(body)) return motion;
  RowMatrixXd poses = RowMatrixXd::Zero(motion.num_frames(), 3 * body.num_joints());
  for (int t = 0; t < motion.num_frames(); ++t) {
    const BodyPose pose = PoseFromAxisAngle(body, motion.poses.row(t).transpose(), motion.trans.row(t).transpose());
    for (size_t j = 0; j < pose.rotations.size(); ++j) {
      poses.row(t).segment<3>(3 * Eigen::Index(j)) = AxisAngleFromRotation(pose.rotations[j]).transpose();
    }
  }
  const Eigen::Index same = std::min<Eigen::Index>(motion.poses.cols(), Eigen::Index{3} * kBodyJointsOfSmpl);
  poses.leftCols(same) = motion.poses.leftCols(same);
  motion.poses = std::move(poses);
  return motion;
}

SkinSummary ExportSkins(const ExportInputs& inputs, const ExportTrackRequest& request) {
  std::vector<std::string> textures;
  for (const std::string& path : request.textures) {
    textures.push_back(ReadFileBytes(path));
    if (!textures.back().starts_with("\x89PNG")) throw std::runtime_error(path + ": not a PNG file");
  }
  if (request.form == TrackForm::kFbx) {
    return WriteFbx(request.out, inputs.Scene(), {request.rig, request.correctives, std::move(textures)});
  }
  GlbOptions options;
  options.correctives = request.correctives;
  options.textures = std::move(textures);
  return WriteGlb(request.out, inputs.Scene(), options);
}

void Write(const ExportInputs& inputs, const ExportTrackRequest& request, const PipelineCallbacks& callbacks,
           ExportTrackReport* report) {
  const Track& track = inputs.track();
  const Eigen::Vector3d pelvis = inputs.body->RestJoints(track.motion.betas).row(0).transpose();
  switch (request.form) {
    case TrackForm::kVertices:
      return ExportVertices(inputs, request, callbacks);
    case TrackForm::kJoints:
      return ExportJoints(inputs, request);
    case TrackForm::kObj:
      return ExportObj(inputs, request, callbacks);
    case TrackForm::kAmass:
      return WriteAmass(request.out, MotionWithHands(inputs, request, report), pelvis);
    case TrackForm::kBvh:
      return WriteBvh(request.out, MotionOfEveryFrame(inputs, request, report), *inputs.body, request.rig);
    case TrackForm::kGlb:
    case TrackForm::kFbx:
      report->skin = ExportSkins(inputs, request);
      return;
    case TrackForm::kSmplx:
      return WriteAmassSmplx(request.out, MotionWithHands(inputs, request, report), pelvis);
    case TrackForm::kTrc:
    case TrackForm::kC3d: {
      const ExportScene scene = inputs.Scene();
      const MarkerTrajectories markers = HalpeMarkers(scene, scene.people[0]);
      return request.form == TrackForm::kTrc ? WriteTrc(request.out, markers) : WriteC3d(request.out, markers);
    }
    case TrackForm::kColmap:
      return WriteColmap(request.out, inputs.Scene());
    case TrackForm::kPose2Sim:
      if (track.HasMovingCamera()) {
        throw std::runtime_error(request.tracks[0] +
                                 ": the camera moves, and a Pose2Sim calibration is of cameras that stand still; "
                                 "expected --what colmap");
      }
      return WritePose2SimCalibration(request.out, "cam_01", track.camera, inputs.world);
    case TrackForm::kAngles:
      report->gait = ExportAngles(*inputs.body, track, inputs.world, request.out, request.events);
      return;
  }
}

size_t BytesUnder(const std::string& path) {
  if (!std::filesystem::is_directory(path)) return std::filesystem::file_size(path);
  size_t bytes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    if (entry.is_regular_file()) bytes += entry.file_size();
  }
  return bytes;
}

/// Of a request whose options and files are as they must be.
ExportTrackReport ExportChecked(const ExportTrackRequest& request, const BodyModel& body,
                                const std::vector<const Track*>& tracks, const PipelineCallbacks& callbacks) {
  const Stopwatch watch;
  const ExportInputs inputs = CheckedInputs(request, body, tracks);
  ExportTrackReport report;
  report.num_frames = inputs.track().num_frames();
  report.out = request.out;
  report.uses_world = request.world_axes || !HasAxes(request.form);
  report.world = inputs.world;
  try {
    Write(inputs, request, callbacks, &report);
  } catch (const std::invalid_argument& error) {  // what the track holds has no place in the form
    throw std::runtime_error(request.tracks[0] + ": " + error.what());
  }
  report.bytes = BytesUnder(request.out);
  report.seconds = watch.seconds();
  return report;
}

}  // namespace

const std::vector<std::string>& TrackFormNames() {
  static const std::vector<std::string> names = {"vertices", "joints", "obj", "amass",  "bvh",      "glb",   "fbx",
                                                 "smplx",    "trc",    "c3d", "colmap", "pose2sim", "angles"};
  return names;
}

TrackForm TrackFormFromString(const std::string& name) {
  const std::vector<std::string>& names = TrackFormNames();
  const auto found = std::find(names.begin(), names.end(), name);
  BODYLOOM_CHECK(found != names.end(), "'", name, "' is not a form of a track");
  return static_cast<TrackForm>(found - names.begin());
}

std::string ToText(const ExportTrackReport& report) {
  std::string text;
  if (report.uses_world) text += "world    " + report.world.BriefReport() + "\n";
  if (report.lost_between > 0) {
    text += Concatenate("filled   ", report.lost_between, " lost frames by interpolation between their neighbours\n");
  }
  if (report.lost_before + report.lost_after > 0) {
    text += Concatenate("left out ", report.lost_before, " frames before the first and ", report.lost_after,
                        " after the last that show the person\n");
  }
  if (report.skin.bytes > 0) {
    char line[160];
    std::snprintf(
        line, sizeof line, "skin     %d corrective shapes, %s joints a vertex: %.2f mm off (rms), %.2f mm at most\n",
        report.skin.shapes, report.skin.influences > 0 ? std::to_string(report.skin.influences).c_str() : "all",
        1e3 * report.skin.rms_error_m, 1e3 * report.skin.max_error_m);
    text += line;
  }
  if (report.gait) text += "gait     " + report.gait->BriefReport() + "\n";
  return text + "wrote " + report.out + "\n";
}

ExportTrackReport ExportTrack(const ExportTrackRequest& request, const PipelineCallbacks& callbacks) {
  CheckExportOptions(request);
  for (const std::string& track : request.tracks) RequireReadable(track, "track");
  RequireReadableBody(request.body);
  RequireDistinct(request.tracks, {request.out, request.events});
  RequireDistinct({request.body}, {request.out, request.events});
  CheckOtherFilesOf(request);
  std::vector<Track> tracks;
  for (const std::string& path : request.tracks) tracks.push_back(ReadTrack(path, MovingCamera::kTake));
  // A body with fingers takes tracks without them, too.
  const auto most_joints = std::max_element(tracks.begin(), tracks.end(), [](const Track& a, const Track& b) {
    return a.motion.poses.cols() < b.motion.poses.cols();
  });
  const std::shared_ptr<const BodyModel> body = BodyOfTrack(request.body, *most_joints);
  std::vector<const Track*> each;
  each.reserve(tracks.size());
  for (const Track& track : tracks) each.push_back(&track);
  return ExportChecked(request, *body, each, callbacks);
}

ExportTrackReport ExportTrack(const ExportTrackRequest& request, const BodyModel& body,
                              const std::vector<const Track*>& tracks, const PipelineCallbacks& callbacks) {
  CheckExportOptions(request);
  CheckOtherFilesOf(request);
  BODYLOOM_CHECK(tracks.size() == request.tracks.size(), tracks.size(), " tracks to write with ", request.tracks.size(),
                 " names");
  return ExportChecked(request, body, tracks, callbacks);
}

}  // namespace bodyloom
