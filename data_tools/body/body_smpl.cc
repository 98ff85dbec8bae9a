// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body/body_smpl.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "data_tools/body/body_landmarks.h"
#include "data_tools/formats/ndarray.h"
#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr int kBodyJoints = 22;  // SMPL-H/X share SMPL's first 22 joints
constexpr int kHandValues = 45;  // 15 joints a hand, axis-angle
constexpr int kSmplVertices = 6890, kSmplxVertices = 10475;
constexpr int kSmplJoints = 24, kSmplhJoints = 52, kSmplxJoints = 55;

/// Index of the first left-hand joint; −1 for bodies without finger joints.
int FirstHandJoint(int num_joints) { return num_joints == kSmplhJoints ? 22 : num_joints == kSmplxJoints ? 25 : -1; }

/// Names of SMPL-H's and SMPL-X's joints; empty for others (BodyModel then uses SMPL's).
std::vector<std::string> HandedJointNames(int num_joints) {
  if (FirstHandJoint(num_joints) < 0) return {};
  std::vector<std::string> names(SmplJointNames().begin(), SmplJointNames().begin() + kBodyJoints);
  if (num_joints == kSmplxJoints) names.insert(names.end(), {"jaw", "l_eye", "r_eye"});
  for (const char* side : {"l_", "r_"}) {
    for (const char* finger : {"index", "middle", "pinky", "ring", "thumb"}) {
      for (const char* joint : {"1", "2", "3"}) names.push_back(std::string(side) + finger + joint);
    }
  }
  return names;
}

std::string FamilyName(const NamedArrays& arrays, int V, int J) {
  if (arrays.Find("cage_v") != nullptr) return "bodyloom";  // only the built-in body carries its control cage
  if (V == kSmplVertices && J == kSmplJoints) return "smpl";
  if (V == kSmplVertices && J == kSmplhJoints) return "smplh";
  if (V == kSmplxVertices && J == kSmplxJoints) return "smplx";
  return std::filesystem::path(arrays.where()).stem().string();
}

/// An n×3 array of indices below `limit`.
MatrixX3i IndexTriples(const NamedArrays& arrays, const std::string& name, int64_t rows, int64_t limit) {
  const NdArray& array = arrays.Require(name, {rows, 3});
  const std::vector<int64_t> values = WholeNumbers(array, name, arrays.where());
  MatrixX3i triples(array.shape[0], 3);
  for (size_t i = 0; i < values.size(); ++i) {
    if (values[i] < 0 || values[i] >= limit) {
      arrays.Fail(Concatenate(name, ": row ", i / 3, " names index ", values[i], ", expected 0..", limit - 1));
    }
    triples.data()[i] = static_cast<int>(values[i]);
  }
  return triples;
}

std::vector<int> Parents(const NamedArrays& arrays) {
  const NdArray& tree = arrays.Require("kintree_table", {2, -1});
  const std::vector<int64_t> values = WholeNumbers(tree, "kintree_table", arrays.where());
  const auto J = static_cast<size_t>(tree.shape[1]);
  if (J == 0) arrays.Fail("kintree_table: no joints");
  std::vector<int> parents(J, -1);
  if (values[0] != -1 && values[0] != 0 && values[0] != 4294967295) {
    arrays.Fail(Concatenate("kintree_table: the root's parent is ", values[0], ", expected -1 or 4294967295"));
  }
  for (size_t j = 1; j < J; ++j) {
    if (values[j] < 0 || values[j] >= static_cast<int64_t>(j)) {
      arrays.Fail(Concatenate("kintree_table: parent of joint ", j, " is ", values[j], ", expected an earlier joint"));
    }
    parents[j] = static_cast<int>(values[j]);
  }
  return parents;
}

/// The non-zero entries of a dense array.
SparseRows Sparse(const NdArray& dense) {
  const std::vector<double> values = dense.ToDoubles();
  const Eigen::Index rows = dense.shape[0], columns = dense.shape[1];
  SparseRows sparse(rows, columns);
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index r = 0; r < rows; ++r) {
    for (Eigen::Index c = 0; c < columns; ++c) {
      const double x = values[r * columns + c];
      if (x != 0) entries.emplace_back(r, c, x);
    }
  }
  sparse.setFromTriplets(entries.begin(), entries.end());
  return sparse;
}

RowMatrixXf ShapeDirections(const NamedArrays& arrays, int64_t V, int max_betas) {
  if (arrays.Find("shapedirs") == nullptr) return RowMatrixXf(3 * V, 0);
  const NdArray& array = arrays.Require("shapedirs", {V, 3, -1});
  const int64_t columns = array.shape[2];
  int64_t keep = columns;
  if (V == kSmplxVertices && columns == 20) keep = 10;
  if (V == kSmplxVertices && columns == 400) keep = 300;
  if (max_betas > 0) keep = std::min<int64_t>(keep, max_betas);
  const std::vector<float> values = array.ToFloats();
  const Eigen::Map<const RowMatrixXf> all(values.data(), 3 * V, columns);
  return all.leftCols(keep);
}

PoseCorrectives PoseDirections(const NamedArrays& arrays, int V, int J) {
  if (arrays.Find("posedirs") == nullptr) return {};
  const std::vector<float> values = arrays.Require("posedirs", {V, 3, 9 * (J - 1)}).ToFloats();
  return PoseCorrectivesFromDense(values.data(), V, J);
}

Eigen::VectorXd HandMean(const NamedArrays& arrays, int J) {
  const int first = FirstHandJoint(J);
  if (first < 0 || arrays.Find("hands_meanl") == nullptr || arrays.Find("hands_meanr") == nullptr) return {};
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(3 * J);
  const char* names[] = {"hands_meanl", "hands_meanr"};
  for (int hand = 0; hand < 2; ++hand) {
    const std::vector<double> values = arrays.Require(names[hand], {kHandValues}).ToDoubles();
    std::copy(values.begin(), values.end(), mean.data() + 3 * first + hand * kHandValues);
  }
  if (!mean.allFinite()) arrays.Fail("hands_meanl/r: NaN or infinite values");
  return mean;
}

void ReadSurfaceCoordinates(const NamedArrays& arrays, BodyModelData* body) {
  const int64_t F = body->faces.rows();
  if (arrays.Find("vt") != nullptr && arrays.Find("ft") != nullptr) {
    const NdArray& vt = arrays.Require("vt", {-1, 2});
    const std::vector<float> values = vt.ToFloats();
    body->vt = Eigen::Map<const MatrixX2f>(values.data(), vt.shape[0], 2);
    body->ft = IndexTriples(arrays, "ft", F, vt.shape[0]);
  }
  if (arrays.Find("part") != nullptr) {
    for (const int64_t part : WholeNumbers(arrays.Require("part", {F}), "part", arrays.where())) {
      if (part < 0 || part > 24) arrays.Fail(Concatenate("part: ", part, ", expected 0..24"));
      body->face_part.push_back(static_cast<uint8_t>(part));
    }
    const std::vector<float> values = arrays.Require("iu_uv", {F, 3, 2}).ToFloats();
    body->face_iuv = Eigen::Map<const RowMatrixXf>(values.data(), F, 6);
    if (!body->face_iuv.allFinite()) arrays.Fail("iu_uv: NaN or infinite values");
  }
}

std::vector<Landmark> ReadLandmarks(const NamedArrays& arrays, int64_t V) {
  const NdArray* names = arrays.Find("landmark_names");
  if (names == nullptr) return {};
  if (!names->is_text() || names->shape.size() != 1) arrays.Fail("landmark_names: expected a list of names");
  const std::vector<std::string> texts = names->ToStrings();
  if (!std::all_of(texts.begin(), texts.end(), IsOneLine)) arrays.Fail("landmark_names: control characters");
  const auto n = static_cast<int64_t>(texts.size());
  const std::vector<int64_t> begin =
      WholeNumbers(arrays.Require("landmark_indptr", {n + 1}), "landmark_indptr", arrays.where());
  const std::vector<int64_t> index =
      WholeNumbers(arrays.Require("landmark_indices", {-1}), "landmark_indices", arrays.where());
  const std::vector<double> weight =
      arrays.Require("landmark_weights", {static_cast<int64_t>(index.size())}).ToDoubles();
  if (begin.front() != 0 || begin.back() != static_cast<int64_t>(index.size()) ||
      !std::is_sorted(begin.begin(), begin.end())) {
    arrays.Fail("landmark_indptr: expected offsets rising from 0 to " + std::to_string(index.size()));
  }
  std::vector<Landmark> landmarks;
  for (int64_t i = 0; i < n; ++i) {
    Landmark landmark{texts[i], {}, {}};
    for (int64_t k = begin[i]; k < begin[i + 1]; ++k) {
      if (index[k] < 0 || index[k] >= V) {
        arrays.Fail(Concatenate("landmark_indices: ", index[k], ", expected 0..", V - 1));
      }
      landmark.vertices.push_back(static_cast<int>(index[k]));
      landmark.weights.push_back(weight[k]);
    }
    landmarks.push_back(std::move(landmark));
  }
  return landmarks;
}

}  // namespace

NamedArrays::NamedArrays(const NpzArrays& arrays, std::string where) : where_(std::move(where)) {
  for (const auto& [name, array] : arrays) arrays_[name] = &array;
}

NamedArrays::NamedArrays(const PickleValue& pickle, std::string where) : where_(std::move(where)) {
  if (pickle.kind != PickleValue::Kind::kDict) Fail("the pickle holds no dictionary, expected that of a body model");
  for (const auto& [name, value] : pickle.dict) {
    if (value->kind == PickleValue::Kind::kArray) arrays_[name] = &value->array;
  }
}

const NdArray* NamedArrays::Find(const std::string& name) const {
  const auto it = arrays_.find(name);
  return it == arrays_.end() ? nullptr : it->second;
}

const NdArray& NamedArrays::Require(const std::string& name, const std::vector<int64_t>& shape) const {
  const NdArray* array = Find(name);
  if (array == nullptr) {
    std::vector<std::string> names;
    for (const auto& [key, value] : arrays_) names.push_back(key);
    Fail("no array '" + name + "', expected that of a body model; it holds " + PrintableList(names));
  }
  bool fits = array->is_number() && array->shape.size() == shape.size();
  std::string expected;
  for (size_t d = 0; d < shape.size(); ++d) {
    fits = fits && (shape[d] < 0 || array->shape[d] == shape[d]);
    expected += (d == 0 ? "" : "x") + (shape[d] < 0 ? std::string("n") : std::to_string(shape[d]));
  }
  if (!fits) {
    Fail(name + ": " + (array->is_number() ? array->ShapeText() : "not an array of numbers") + ", expected " +
         expected);
  }
  return *array;
}

void NamedArrays::Fail(const std::string& message) const { throw std::runtime_error(where_ + ": " + message); }

BodyModelData BodyFromArrays(const NamedArrays& arrays, const LoadBodyOptions& options) {
  BodyModelData body;
  const NdArray& vertices = arrays.Require("v_template", {-1, 3});
  const int64_t V = vertices.shape[0];
  if (V == 0 || V > 50'000'000) arrays.Fail(Concatenate("v_template: ", V, " vertices"));
  body.v_template = vertices.ToMatrix();
  body.parents = Parents(arrays);
  const int J = static_cast<int>(body.parents.size());
  body.name = FamilyName(arrays, static_cast<int>(V), J);
  body.joint_names = HandedJointNames(J);
  body.faces = IndexTriples(arrays, "f", -1, V);
  body.weights = Sparse(arrays.Require("weights", {V, J}));
  body.J_regressor = Sparse(arrays.Require("J_regressor", {J, V}));
  body.shapedirs = ShapeDirections(arrays, V, options.max_betas);
  body.posedirs = PoseDirections(arrays, static_cast<int>(V), J);
  if (!options.flat_hand_mean) body.pose_mean = HandMean(arrays, J);
  ReadSurfaceCoordinates(arrays, &body);
  body.landmarks = ReadLandmarks(arrays, V);
  if (body.landmarks.empty()) body.landmarks = StandardLandmarks(body);
  return body;
}

}  // namespace bodyloom
