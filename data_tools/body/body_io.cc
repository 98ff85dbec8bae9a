// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body/body_io.h"

#include <matio.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <memory>
#include <set>
#include <sstream>
#include <stdexcept>
#include <unordered_map>
#include <utility>
#include <vector>

#include "data_tools/body/body_compact.h"
#include "data_tools/body/body_smpl.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/mat_headers.h"
#include "data_tools/formats/obj.h"
#include "data_tools/formats/zip.h"
#include "geometry/base/check.h"
#include "geometry/math/arrays.h"

namespace bodyloom {
namespace {

// Finds a body's triangles by their vertices, independently of their first corner.

class FacesByVertices {
 public:
  explicit FacesByVertices(const MatrixX3i& faces);

  /// Index of the face with exactly these three vertices, the first if there are several; −1 if there is none.
  [[nodiscard]] int Find(const std::array<int, 3>& vertices) const;

 private:
  struct Hash {
    size_t operator()(const std::array<int, 3>& key) const;
  };
  std::unordered_map<std::array<int, 3>, int, Hash> faces_;  // by sorted vertices
};

std::array<int, 3> Sorted(std::array<int, 3> key) {
  std::sort(key.begin(), key.end());
  return key;
}

size_t FacesByVertices::Hash::operator()(const std::array<int, 3>& key) const {
  uint64_t hash = 0;
  for (const int v : key) hash = (hash ^ static_cast<uint32_t>(v)) * 0x9E3779B97F4A7C15U;
  return hash ^ (hash >> 32);
}

FacesByVertices::FacesByVertices(const MatrixX3i& faces) {
  faces_.reserve(faces.rows());
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    faces_.try_emplace(Sorted({faces(f, 0), faces(f, 1), faces(f, 2)}), static_cast<int>(f));
  }
}

int FacesByVertices::Find(const std::array<int, 3>& vertices) const {
  const auto it = faces_.find(Sorted(vertices));
  return it == faces_.end() ? -1 : it->second;
}

/// For each corner of `face`, its index in `vertices`: vertices[result[c]] = face[c]. All three must occur.
std::array<int, 3> CornerOrder(const std::array<int, 3>& face, const std::array<int, 3>& vertices) {
  std::array<int, 3> order{};
  for (int c = 0; c < 3; ++c) {
    const auto it = std::find(vertices.begin(), vertices.end(), face[c]);
    BODYLOOM_CHECK(it != vertices.end(), "vertex ", face[c], " is not a corner of the other triangle");
    order[c] = static_cast<int>(it - vertices.begin());
  }
  return order;
}

/// Corner triples of a polygon: all four of a quad (a body may split it either way), the fan of a larger one.
std::vector<std::array<int, 3>> Triangles(int corners) {
  if (corners == 4) return {{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}};
  std::vector<std::array<int, 3>> triangles;
  for (int k = 2; k < corners; ++k) triangles.push_back({0, k - 1, k});
  return triangles;
}

constexpr int kParts = 24;
constexpr size_t kMaxValues = 1'000'000;  // UV_Processed.mat holds at most 41,322 a variable

/// One variable's numbers in MATLAB's column order.
struct MatMatrix {
  size_t rows = 0, columns = 0;
  std::vector<double> values;
  [[nodiscard]] double at(size_t r, size_t c) const { return values[c * rows + r]; }
};

template <typename T>
std::vector<double> Numbers(const matvar_t& variable, size_t n) {
  const auto* data = static_cast<const T*>(variable.data);
  return {data, data + n};
}

class MatFile {
 public:
  explicit MatFile(const std::string& path) : path_(path), file_(nullptr, &Mat_Close) {
    CheckMatHeaders(path);
    file_.reset(Mat_Open(path.c_str(), MAT_ACC_RDONLY));
    if (file_ == nullptr) Fail("not a MATLAB file that can be opened, expected DensePose's UV_Processed.mat");
  }

  [[noreturn]] void Fail(const std::string& message) const { throw std::runtime_error(path_ + ": " + message); }

  /// A matrix of finite numbers; columns 0: a vector, whichever way it lies.
  MatMatrix Read(const char* name, size_t columns) const {
    using Variable = std::unique_ptr<matvar_t, decltype(&Mat_VarFree)>;
    // The header first: sizes are checked before the values are read.
    const Variable info(Mat_VarReadInfo(file_.get(), name), &Mat_VarFree);
    if (info == nullptr) Fail(Concatenate("no variable '", name, "', expected DensePose's UV_Processed.mat"));
    if (info->rank != 2 || info->isComplex != 0) Fail(Concatenate("'", name, "' is not a real matrix"));
    MatMatrix matrix{info->dims[0], info->dims[1], {}};
    if (matrix.rows == 0 || matrix.columns == 0 || matrix.rows > kMaxValues / matrix.columns) {
      Fail(Concatenate("'", name, "' is ", matrix.rows, "x", matrix.columns, ", expected a few thousand rows"));
    }
    if (columns == 0 ? matrix.rows != 1 && matrix.columns != 1 : matrix.columns != columns) {
      Fail(Concatenate("'", name, "' is ", matrix.rows, "x", matrix.columns, ", expected ",
                       columns == 0 ? "a vector" : "three columns"));
    }
    const size_t n = matrix.rows * matrix.columns;
    const Variable variable(Mat_VarRead(file_.get(), name), &Mat_VarFree);
    if (variable == nullptr || variable->data == nullptr || variable->data_size <= 0 ||
        variable->nbytes < n * static_cast<size_t>(variable->data_size)) {
      Fail(Concatenate("the values of '", name, "' cannot be read, the file is damaged"));
    }
    matrix.values = Values(*variable, name, n);
    for (const double x : matrix.values) {
      if (!std::isfinite(x)) Fail(Concatenate("'", name, "' holds NaN or infinite values"));
    }
    return matrix;
  }

 private:
  std::vector<double> Values(const matvar_t& variable, const char* name, size_t n) const {
    switch (variable.class_type) {
      case MAT_C_DOUBLE:
        return Numbers<double>(variable, n);
      case MAT_C_SINGLE:
        return Numbers<float>(variable, n);
      case MAT_C_INT8:
        return Numbers<int8_t>(variable, n);
      case MAT_C_UINT8:
        return Numbers<uint8_t>(variable, n);
      case MAT_C_INT16:
        return Numbers<int16_t>(variable, n);
      case MAT_C_UINT16:
        return Numbers<uint16_t>(variable, n);
      case MAT_C_INT32:
        return Numbers<int32_t>(variable, n);
      case MAT_C_UINT32:
        return Numbers<uint32_t>(variable, n);
      default:
        Fail(Concatenate("'", name, "' is not a matrix of numbers"));
    }
  }

  std::string path_;
  std::unique_ptr<mat_t, decltype(&Mat_Close)> file_;
};

/// A 1-based index as a 0-based one.
int Index(const MatFile& file, double value, size_t limit, const char* name) {
  if (value < 1 || value > static_cast<double>(limit) || value != std::floor(value)) {
    file.Fail(Concatenate("'", name, "' holds ", value, ", expected 1..", limit));
  }
  return static_cast<int>(value) - 1;
}

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

void UvFromObj(const std::string& path, BodyModelData* body) {
  const ObjMesh mesh = ReadObj(path);
  const auto fail = [&path](const std::string& message) { throw std::runtime_error(path + ": " + message); };
  if (mesh.positions.rows() != body->v_template.rows()) {
    fail(Concatenate(mesh.positions.rows(), " vertices, expected the body's ", body->v_template.rows(),
                     " in the same order"));
  }
  if (mesh.uv.rows() == 0) fail("no texture coordinates (vt lines)");
  if (mesh.uv.minCoeff() < -1e-3 || mesh.uv.maxCoeff() > 1 + 1e-3) {
    fail(Concatenate("texture coordinates from ", mesh.uv.minCoeff(), " to ", mesh.uv.maxCoeff(), ", expected 0 to 1"));
  }
  const FacesByVertices lookup(body->faces);
  MatrixX3i ft = MatrixX3i::Constant(body->faces.rows(), 3, -1);
  for (int f = 0; f < mesh.num_faces(); ++f) {
    const int begin = mesh.face_begin[f];
    for (const std::array<int, 3>& corners : Triangles(mesh.face_begin[f + 1] - begin)) {
      std::array<int, 3> vertices{}, uv{};
      for (int c = 0; c < 3; ++c) {
        vertices[c] = mesh.corner_position[begin + corners[c]];
        uv[c] = mesh.corner_uv[begin + corners[c]];
      }
      const int face = lookup.Find(vertices);
      if (face < 0) continue;
      if (uv[0] < 0 || uv[1] < 0 || uv[2] < 0) fail(Concatenate("face ", f + 1, " has no texture coordinates"));
      const std::array<int, 3> order =
          CornerOrder({body->faces(face, 0), body->faces(face, 1), body->faces(face, 2)}, vertices);
      for (int c = 0; c < 3; ++c) ft(face, c) = uv[order[c]];
    }
  }
  for (Eigen::Index f = 0; f < ft.rows(); ++f) {
    if (ft(f, 0) < 0) {
      fail(Concatenate("no face with the vertices ", body->faces(f, 0), " ", body->faces(f, 1), " ", body->faces(f, 2),
                       " of the body's face ", f, ", expected a mesh of the same topology"));
    }
  }
  body->vt = mesh.uv.cast<float>().cwiseMax(0.0F).cwiseMin(1.0F);
  body->ft = ft;
}

PartsSummary PartsFromUvProcessedMat(const std::string& path, BodyModelData* body) {
  const MatFile file(path);
  const MatMatrix faces = file.Read("All_Faces", 3);
  const MatMatrix parts = file.Read("All_FaceIndices", 0);
  const MatMatrix vertices = file.Read("All_vertices", 0);
  const MatMatrix u = file.Read("All_U_norm", 0), v = file.Read("All_V_norm", 0);
  if (parts.values.size() != faces.rows) {
    file.Fail(Concatenate("'All_FaceIndices' holds ", parts.values.size(), " values, expected ", faces.rows));
  }
  const size_t n = vertices.values.size();
  if (u.values.size() != n || v.values.size() != n) {
    file.Fail(Concatenate("'All_U_norm' and 'All_V_norm' hold ", u.values.size(), " and ", v.values.size(),
                          " values, expected ", n));
  }
  const FacesByVertices lookup(body->faces);
  std::vector<uint8_t> face_part(body->faces.rows(), 0);
  RowMatrixXf face_iuv = RowMatrixXf::Zero(body->faces.rows(), 6);
  PartsSummary summary;
  for (size_t f = 0; f < faces.rows; ++f) {
    std::array<int, 3> corner{}, triangle{};
    for (int c = 0; c < 3; ++c) {
      corner[c] = Index(file, faces.at(f, c), n, "All_Faces");
      triangle[c] = Index(file, vertices.values[corner[c]], body->v_template.rows(), "All_vertices");
    }
    const int part = Index(file, parts.values[f], kParts, "All_FaceIndices") + 1;
    const int face = lookup.Find(triangle);
    if (face < 0) continue;
    const std::array<int, 3> order =
        CornerOrder({body->faces(face, 0), body->faces(face, 1), body->faces(face, 2)}, triangle);
    for (int c = 0; c < 3; ++c) {
      const int point = corner[order[c]];
      face_iuv(face, 2 * c) = static_cast<float>(u.values[point]);
      face_iuv(face, 2 * c + 1) = static_cast<float>(v.values[point]);
    }
    summary.faces_with_part += face_part[face] == 0 ? 1 : 0;
    face_part[face] = static_cast<uint8_t>(part);
  }
  if (summary.faces_with_part == 0) file.Fail("none of its faces is one of the body's, expected SMPL's topology");
  summary.faces_without_part = static_cast<int>(body->faces.rows()) - summary.faces_with_part;
  body->face_part = std::move(face_part);
  body->face_iuv = std::move(face_iuv);
  return summary;
}

}  // namespace bodyloom
