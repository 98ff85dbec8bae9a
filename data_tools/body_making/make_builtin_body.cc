// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body_making/make_builtin_body.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "data_tools/body_making/body_charts.h"
#include "data_tools/body_making/cage.h"
#include "data_tools/body_making/finger_joints.h"
#include "data_tools/body_making/left_half_arrays.h"
#include "data_tools/body_making/pose_correctives.h"
#include "data_tools/body_making/subdivision.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"

// Made by bodyloom_embed() in data_tools/CMakeLists.txt.
extern "C" {
extern const char bodyloom_builtin_body_cage_begin[], bodyloom_builtin_body_cage_end[];
extern const char bodyloom_builtin_body_parts_begin[], bodyloom_builtin_body_parts_end[];
}

namespace bodyloom {
namespace {

/// The mirror image of each joint: l_ and r_ of a name exchanged.
std::vector<int> MirrorOfJoints(const std::vector<std::string>& names) {
  std::vector<int> mirror(names.size());
  for (size_t j = 0; j < names.size(); ++j) {
    std::string name = names[j];
    if (name.starts_with("l_")) {
      name[0] = 'r';
    } else if (name.starts_with("r_")) {
      name[0] = 'l';
    }
    mirror[j] = static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
  }
  return mirror;
}

std::string MirrorOfLandmark(const std::string& name) {
  return name.starts_with("left_") ? "right_" + name.substr(5) : name;
}

void FillShape(const Cage& cage, const RefinedCage& refined, const Eigen::MatrixXd& left_cage_shape,
               BodyModelData* body) {
  body->v_template = refined.fine_from_cage * cage.vertices;
  const Eigen::MatrixXd shape = refined.fine_from_cage * MirrorCageRows(cage, left_cage_shape);
  const Eigen::Index components = shape.cols() / 3;
  body->shapedirs.resize(3 * shape.rows(), components);
  for (Eigen::Index v = 0; v < shape.rows(); ++v) {
    for (Eigen::Index b = 0; b < components; ++b) {
      for (int c = 0; c < 3; ++c) body->shapedirs(3 * v + c, b) = static_cast<float>(shape(v, 3 * b + c));
    }
  }
}

void FillRegressor(const RefinedCage& refined, const std::vector<int>& joint_mirror,
                   const std::vector<int>& left_joints, const std::vector<WeightedIndices>& rows, BodyModelData* body) {
  std::vector<Eigen::Triplet<double>> entries;
  for (size_t i = 0; i < left_joints.size(); ++i) {
    const int joint = left_joints[i];
    for (const auto& [vertex, weight] : rows[i]) {
      entries.emplace_back(joint, vertex, weight);
      if (joint_mirror[joint] != joint) entries.emplace_back(joint_mirror[joint], refined.mirror[vertex], weight);
    }
  }
  body->J_regressor.resize(static_cast<Eigen::Index>(joint_mirror.size()),
                           static_cast<Eigen::Index>(refined.mirror.size()));
  body->J_regressor.setFromTriplets(entries.begin(), entries.end());
}

void FillLandmarks(const RefinedCage& refined, const LeftHalfArrays& arrays, BodyModelData* body) {
  for (size_t i = 0; i < arrays.landmark_names.size(); ++i) {
    Landmark landmark{arrays.landmark_names[i], {}, {}};
    for (const auto& [vertex, weight] : arrays.landmarks[i]) {
      landmark.vertices.push_back(vertex);
      landmark.weights.push_back(weight);
    }
    body->landmarks.push_back(landmark);
    const std::string mirrored_name = MirrorOfLandmark(landmark.name);
    if (mirrored_name == landmark.name) continue;
    landmark.name = mirrored_name;
    for (int& vertex : landmark.vertices) vertex = refined.mirror[vertex];
    body->landmarks.push_back(landmark);
  }
}

void FillCharts(const Cage& cage, const RefinedCage& refined, const LeftHalfArrays& arrays,
                const std::string& cage_name, BodyModelData* body) {
  std::vector<int> quad_chart;
  std::vector<bool> quad_is_right;
  for (size_t q = 0; q < refined.quads.size(); ++q) {
    const size_t cage_quad = q / kQuadsPerCageQuad;
    const std::string& name = cage.child_charts[cage_quad][(q % kQuadsPerCageQuad) / 4];
    const int chart = FindChartKind(name);
    if (chart < 0) {
      throw std::runtime_error(cage_name + ": quad " + std::to_string(cage_quad) + ": unknown chart '" +
                               PrintableText(name) + "'");
    }
    quad_chart.push_back(chart);
    quad_is_right.push_back(static_cast<int>(q) >= refined.num_left_quads);
  }
  ChartedFaces faces =
      BuildCharts(refined.quads, quad_chart, quad_is_right, refined.mirror, arrays.charts, arrays.atlas_from_chart);
  body->vt = std::move(faces.vt);
  body->ft = std::move(faces.ft);
  body->face_part = std::move(faces.face_part);
  body->face_iuv = std::move(faces.face_iuv);
}

}  // namespace

BuiltinBodySources EmbeddedBuiltinBodySources() {
  BuiltinBodySources sources;
  sources.cage_text.assign(bodyloom_builtin_body_cage_begin, bodyloom_builtin_body_cage_end);
  sources.parts_bytes.assign(bodyloom_builtin_body_parts_begin, bodyloom_builtin_body_parts_end);
  return sources;
}

BuiltinBodySources ReadBuiltinBodySources(const std::string& cage_path, const std::string& parts_path) {
  return {ReadFileBytes(cage_path), cage_path, ReadFileBytes(parts_path), parts_path};
}

BodyModelData MakeBuiltinBody(const BuiltinBodySources& sources, MakeBuiltinBodySummary* summary) {
  const Cage cage = ParseCage(sources.cage_text, sources.cage_name);
  RefinedCage refined;
  try {
    refined = RefineCage(cage);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(sources.cage_name + ": cannot be subdivided: " + error.what());
  }

  BodyModelData body;
  body.name = "bodyloom";
  body.joint_names = SmplJointNames();
  body.parents = SmplParents();
  const std::vector<int> joint_mirror = MirrorOfJoints(body.joint_names);
  std::vector<int> left_joints;
  for (size_t j = 0; j < joint_mirror.size(); ++j) {
    if (joint_mirror[j] >= static_cast<int>(j)) left_joints.push_back(static_cast<int>(j));
  }
  const LeftHalfSizes sizes{cage.num_left_vertices, static_cast<int>(refined.left_vertices.size()),
                            static_cast<int>(refined.mirror.size()), static_cast<int>(body.parents.size()),
                            static_cast<int>(left_joints.size())};
  const LeftHalfArrays arrays = ReadLeftHalfArrays(sources.parts_bytes, sources.parts_name, sizes);

  FillShape(cage, refined, arrays.cage_shape, &body);
  body.faces = TrianglesOfQuads(refined.quads);
  FillWeights(refined, joint_mirror, arrays.weights, &body);
  FillRegressor(refined, joint_mirror, left_joints, arrays.regressor, &body);
  std::map<int, std::vector<CorrectiveBlock>> left_correctives;
  for (size_t i = 0; i < refined.left_vertices.size(); ++i) {
    left_correctives[refined.left_vertices[i]] = arrays.correctives[i];
  }
  AddCorrectives(refined, joint_mirror, left_correctives, 0, &body.posedirs);
  FillLandmarks(refined, arrays, &body);
  try {
    FillCharts(cage, refined, arrays, sources.cage_name, &body);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(sources.parts_name + ": charts do not fit " + sources.cage_name + ": " + error.what());
  }
  if (summary != nullptr) {
    summary->cage_vertices = static_cast<int>(cage.mirror.size());
    summary->cage_quads = static_cast<int>(cage.quads.size());
    summary->vertices = static_cast<int>(body.v_template.rows());
    summary->quads = static_cast<int>(refined.quads.size());
  }
  return body;
}

BodyModelData MakeBuiltinBodyWithHands(const BuiltinBodySources& sources) {
  BodyModelData body = MakeBuiltinBody(sources);
  body.name = "bodyloom_hands";
  const Cage cage = ParseCage(sources.cage_text, sources.cage_name);
  try {
    AddFingerJoints(cage, RefineCage(cage), &body);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(sources.cage_name + ": " + error.what());
  }
  return body;
}

}  // namespace bodyloom
