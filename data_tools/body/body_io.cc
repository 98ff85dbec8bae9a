// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body/body_io.h"

#include <algorithm>
#include <iomanip>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "data_tools/body/body_compact.h"
#include "data_tools/body/body_smpl.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/zip.h"

namespace bodyloom {
namespace {

BodyModelData ParseBody(const std::string& bytes, const std::string& where, const LoadBodyOptions& options) {
  if (bytes.empty()) throw std::runtime_error(where + ": an empty file, expected a body model (.npz or .pkl)");
  if (!LooksLikeZip(bytes)) {
    const PicklePtr pickle = ReadPickle(bytes, where);
    return BodyFromArrays(NamedArrays(*pickle, where), options);
  }
  const NpzArrays arrays = ReadNpzBytes(bytes, where);
  if (IsCompactBody(arrays)) return BodyFromCompact(arrays, where, options);
  return BodyFromArrays(NamedArrays(arrays, where), options);
}

}  // namespace

BodyModel LoadBodyBytes(const std::string& bytes, const std::string& where, const LoadBodyOptions& options) {
  BodyModelData data = ParseBody(bytes, where, options);
  try {
    return BodyModel(std::move(data));
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(where + ": " + error.what());
  }
}

BodyModel LoadBody(const std::string& path, const LoadBodyOptions& options) {
  return LoadBodyBytes(ReadFileBytes(path), path, options);
}

BodyModelData LoadBodyData(const std::string& path, const LoadBodyOptions& options) {
  return LoadBody(path, options).data();
}

void SaveBodyCompact(const std::string& path, const BodyModelData& body) {
  WriteNpz(path, CompactFromBody(BodyModel(body).data()));
}

std::string DescribeBody(const BodyModel& body) {
  const BodyModelData& data = body.data();
  const Eigen::RowVector3d size = data.v_template.colwise().maxCoeff() - data.v_template.colwise().minCoeff();
  std::ostringstream text;
  text << std::fixed << std::setprecision(3);
  text << "name             " << body.name() << '\n'
       << "vertices         " << body.num_vertices() << '\n'
       << "faces            " << body.num_faces() << '\n'
       << "joints           " << body.num_joints() << '\n'
       << "shape components " << body.num_betas() << '\n'
       << "size             " << size.y() << " m high, " << size.x() << " m wide, " << size.z() << " m deep (T-pose)\n"
       << "skinning         " << body.influence_joint().size() << " weights, "
       << static_cast<double>(body.influence_joint().size()) / body.num_vertices() << " a vertex\n";
  text << "pose correctives ";
  if (data.posedirs.empty()) {
    text << "none\n";
  } else {
    const double all = static_cast<double>(body.num_vertices()) * std::max(body.num_joints() - 1, 1);
    text << data.posedirs.joint.size() << " blocks, " << std::setprecision(1)
         << 100.0 * static_cast<double>(data.posedirs.joint.size()) / all << " % of vertices x joints\n";
  }
  text << "mean hand pose   " << (data.pose_mean.size() > 0 ? "yes" : "none") << '\n';
  text << "UV               ";
  if (body.has_uv()) {
    text << data.vt.rows() << " UV vertices\n";
  } else {
    text << "none (bring an OBJ with the same vertex order)\n";
  }
  text << "parts            ";
  if (body.has_parts()) {
    const std::set<int> parts(data.face_part.begin(), data.face_part.end());
    text << parts.size() - parts.count(0) << " parts, " << std::count(data.face_part.begin(), data.face_part.end(), 0)
         << " faces without\n";
  } else {
    text << "none (bring DensePose's UV_Processed.mat)\n";
  }
  text << "landmarks        " << data.landmarks.size() << '\n';
  return text.str();
}

}  // namespace bodyloom
