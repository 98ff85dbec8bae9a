// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/export/export_track.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <stdexcept>

#include "bodyloom/data_tools/body/body_or_builtin.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/formats/npz.h"
#include "bodyloom/data_tools/motion/amass.h"
#include "bodyloom/data_tools/motion/bvh_writer.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/pipelines/files.h"
#include "bodyloom/pipelines/track_fits_body.h"
#include "bodyloom/render/overlay.h"

namespace bodyloom {
namespace {

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

void ExportVertices(const Track& track, const BodyModel& body, const ExportTrackRequest& request,
                    const PipelineCallbacks& callbacks) {
  const size_t row = 3 * static_cast<size_t>(body.num_vertices());
  std::vector<float> values(row * track.num_frames(), std::nanf(""));
  for (int t = 0; t < track.num_frames(); ++t) {
    callbacks.Update("export", static_cast<double>(t) / track.num_frames());
    const MatrixX3d vertices = TrackVertices(body, track, t);
    if (vertices.rows() > 0) {
      Eigen::Map<MatrixX3f>(values.data() + row * t, body.num_vertices(), 3) = vertices.cast<float>();
    }
  }
  WriteNpy(request.out, NdArray::FromFloats(values.data(), {track.num_frames(), body.num_vertices(), 3}));
}

void ExportJoints(const Track& track, const ExportTrackRequest& request) {
  const auto num_joints = track.joints.empty() ? 0 : track.joints[0].rows();
  RowMatrixXd values(track.num_frames(), 3 * num_joints);
  for (int t = 0; t < track.num_frames(); ++t) {
    values.row(t) = Eigen::Map<const Eigen::RowVectorXd>(track.joints[t].data(), 3 * num_joints);
  }
  WriteNpy(request.out, NdArray::FromDoubles(values.data(), {track.num_frames(), num_joints, 3}));
}

void ExportObj(const Track& track, const BodyModel& body, const ExportTrackRequest& request,
               const PipelineCallbacks& callbacks) {
  if (request.frame >= 0) {
    const MatrixX3d vertices = TrackVertices(body, track, request.frame);
    if (vertices.rows() == 0) {
      throw std::runtime_error(
          Concatenate(request.track, ": frame ", request.frame, " is lost, there is no body to write"));
    }
    WriteFileAtomically(request.out, ObjText(vertices, body.data()));
    return;
  }
  for (int t = 0; t < track.num_frames(); ++t) {
    callbacks.Update("export", static_cast<double>(t) / track.num_frames());
    const MatrixX3d vertices = TrackVertices(body, track, t);
    if (vertices.rows() > 0) {
      char name[32];
      std::snprintf(name, sizeof name, "frame_%06d.obj", t);
      WriteFileAtomically((std::filesystem::path(request.out) / name).string(), ObjText(vertices, body.data()));
    }
  }
}

}  // namespace

const std::vector<std::string>& TrackFormNames() {
  static const std::vector<std::string> names = {"vertices", "joints", "obj", "amass", "bvh"};
  return names;
}

TrackForm TrackFormFromString(const std::string& name) {
  const std::vector<std::string>& names = TrackFormNames();
  const auto found = std::find(names.begin(), names.end(), name);
  BODYLOOM_CHECK(found != names.end(), "'", name, "' is not a form of a track");
  return static_cast<TrackForm>(found - names.begin());
}

ExportTrackReport ExportTrack(const ExportTrackRequest& request, const PipelineCallbacks& callbacks) {
  RequireReadable(request.track, "track");
  RequireReadable(request.body, "body model");
  RequireDistinct({request.track, request.body}, {request.out});
  if (request.form == TrackForm::kObj && request.frame < 0) {
    RequireWritableFolder(request.out);
  } else {
    RequireWritable(request.out);
  }
  const Track track = ReadTrack(request.track);
  if (request.frame >= track.num_frames()) {
    throw std::runtime_error(
        Concatenate(request.track, ": ", track.num_frames(), " frames, expected one with number ", request.frame));
  }
  const std::shared_ptr<const BodyModel> body = BodyOrBuiltin(request.body);
  RequireTrackFitsBody(track, *body, request.track);
  switch (request.form) {
    case TrackForm::kVertices:
      ExportVertices(track, *body, request, callbacks);
      break;
    case TrackForm::kJoints:
      ExportJoints(track, request);
      break;
    case TrackForm::kObj:
      ExportObj(track, *body, request, callbacks);
      break;
    case TrackForm::kAmass:
      WriteAmass(request.out, track.motion, body->RestJoints(track.motion.betas).row(0));
      break;
    case TrackForm::kBvh:
      WriteBvh(request.out, track.motion, *body);
      break;
  }
  return {track.num_frames(), request.out};
}

}  // namespace bodyloom
