// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <string>

#include "apps/exit_code.h"
#include "apps/interrupt.h"
#include "apps/verbs.h"
#include "bodyloom/data_tools/body/body_or_builtin.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/formats/npz.h"
#include "bodyloom/data_tools/motion/amass.h"
#include "bodyloom/data_tools/motion/bvh_writer.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/pipelines/files.h"
#include "bodyloom/render/overlay.h"

namespace bodyloom {
namespace {

constexpr const char* kFooter =
    "What is written (camera frame, metres, unless said otherwise):\n"
    "  vertices   .npy, frames x vertices x 3, float32; lost frames are NaN\n"
    "  joints     .npy, frames x joints x 3, float64; lost frames are NaN\n"
    "  obj        a folder with frame_000000.obj ..., lost frames left out; with --frame one .obj file\n"
    "  amass      .npz as AMASS has it: SMPL-H's 156 pose columns, z up\n"
    "  bvh        for animation programs: centimetres, y up\n"
    "Examples:\n"
    "  bodyloom export --track track.npz --what bvh --out motion.bvh\n"
    "  bodyloom export --track track.npz --what obj --frame 120 --out frame.obj\n\n";

struct ExportCommand {
  std::string track, what, out, body;
  int frame = -1;
};

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

void ExportVertices(const Track& track, const BodyModel& body, const ExportCommand& command) {
  const size_t row = 3 * static_cast<size_t>(body.num_vertices());
  std::vector<float> values(row * track.num_frames(), std::nanf(""));
  for (int t = 0; t < track.num_frames(); ++t) {
    ThrowIfInterrupted();
    const MatrixX3d vertices = TrackVertices(body, track, t);
    if (vertices.rows() > 0) {
      Eigen::Map<MatrixX3f>(values.data() + row * t, body.num_vertices(), 3) = vertices.cast<float>();
    }
  }
  WriteNpy(command.out, NdArray::FromFloats(values.data(), {track.num_frames(), body.num_vertices(), 3}));
}

void ExportJoints(const Track& track, const BodyModel&, const ExportCommand& command) {
  const auto num_joints = track.joints.empty() ? 0 : track.joints[0].rows();
  RowMatrixXd values(track.num_frames(), 3 * num_joints);
  for (int t = 0; t < track.num_frames(); ++t) {
    values.row(t) = Eigen::Map<const Eigen::RowVectorXd>(track.joints[t].data(), 3 * num_joints);
  }
  WriteNpy(command.out, NdArray::FromDoubles(values.data(), {track.num_frames(), num_joints, 3}));
}

void ExportObj(const Track& track, const BodyModel& body, const ExportCommand& command) {
  if (command.frame >= 0) {
    const MatrixX3d vertices = TrackVertices(body, track, command.frame);
    if (vertices.rows() == 0) {
      throw std::runtime_error(
          Concatenate(command.track, ": frame ", command.frame, " is lost, there is no body to write"));
    }
    WriteFileAtomically(command.out, ObjText(vertices, body.data()));
    return;
  }
  for (int t = 0; t < track.num_frames(); ++t) {
    ThrowIfInterrupted();
    const MatrixX3d vertices = TrackVertices(body, track, t);
    if (vertices.rows() > 0) {
      char name[32];
      std::snprintf(name, sizeof name, "frame_%06d.obj", t);
      WriteFileAtomically((std::filesystem::path(command.out) / name).string(), ObjText(vertices, body.data()));
    }
  }
}

void ExportAmass(const Track& track, const BodyModel& body, const ExportCommand& command) {
  WriteAmass(command.out, track.motion, body.RestJoints(track.motion.betas).row(0));
}

void ExportBvh(const Track& track, const BodyModel& body, const ExportCommand& command) {
  WriteBvh(command.out, track.motion, body);
}

using Exporter = void (*)(const Track&, const BodyModel&, const ExportCommand&);
const std::map<std::string, Exporter> kExporters = {{"vertices", ExportVertices},
                                                    {"joints", ExportJoints},
                                                    {"obj", ExportObj},
                                                    {"amass", ExportAmass},
                                                    {"bvh", ExportBvh}};

void RunExport(const ExportCommand& command) {
  RequireReadable(command.track, "track");
  RequireReadable(command.body, "body model");
  RequireDistinct({command.track, command.body}, {command.out});
  if (command.what == "obj" && command.frame < 0) {
    RequireWritableFolder(command.out);
  } else {
    RequireWritable(command.out);
  }
  const Track track = ReadTrack(command.track);
  if (command.frame >= track.num_frames()) {
    throw std::runtime_error(
        Concatenate(command.track, ": ", track.num_frames(), " frames, expected one with number ", command.frame));
  }
  const std::shared_ptr<const BodyModel> body = BodyOrBuiltin(command.body);
  if (track.motion.poses.cols() > 3 * body->num_joints()) {
    throw std::runtime_error(Concatenate(command.track, ": ", track.motion.poses.cols() / 3, " joints (body '",
                                         track.motion.body, "'), the body '", body->name(), "' has ",
                                         body->num_joints(), "; give the track's own with --body"));
  }
  kExporters.at(command.what)(track, *body, command);
  std::cout << "wrote " << command.out << "\n";
}

}  // namespace

void AddExportVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("export", "Writes a track in another form: vertices, joints, OBJ, AMASS, BVH");
  verb->footer(std::string(kFooter) + kExitCodeHelp);
  auto command = std::make_shared<ExportCommand>();
  ExportCommand& c = *command;
  verb->add_option("--track", c.track, "the track, .npz")->required()->type_name("FILE");
  verb->add_option("--what", c.what, "what to write (below)")
      ->required()
      ->check(CLI::IsMember(kExporters))
      ->type_name("KIND");
  verb->add_option("--out", c.out, "where to write it")->required()->type_name("PATH");
  verb->add_option("--body", c.body, "the track's body (default: the built-in body)")->type_name("FILE");
  verb->add_option("--frame", c.frame, "obj: only this frame, counted from 0")->check(CLI::NonNegativeNumber);
  verb->callback([command, action] { *action = [command] { RunExport(*command); }; });
}

}  // namespace bodyloom
