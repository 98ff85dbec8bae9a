// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body/body_compact.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "data_tools/body/body_codec.h"
#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr const char* kCompactFormat = "bodyloom-body-1";
constexpr double kTemplateGrid = 1.0 / (1 << 21), kShapeGrid = 1.0 / (1 << 22), kUvGrid = 1.0 / (1 << 20);
constexpr int kSkinningBits = 21, kRegressorBits = 28;

template <typename Derived>
Integers GridValues(const Eigen::DenseBase<Derived>& values, double step, const char* what) {
  Integers integers;
  integers.reserve(values.size());
  for (Eigen::Index r = 0; r < values.rows(); ++r) {
    for (Eigen::Index c = 0; c < values.cols(); ++c) integers.push_back(OnGrid(values(r, c), step, what));
  }
  return integers;
}

template <typename Matrix>
Matrix FromGrid(const Integers& integers, Eigen::Index rows, Eigen::Index columns, double step) {
  Matrix matrix(rows, columns);
  for (size_t i = 0; i < integers.size(); ++i) {
    matrix.data()[i] = static_cast<typename Matrix::Scalar>(integers[i] * step);
  }
  return matrix;
}

UnitRows RowsOf(const SparseRows& matrix) {
  UnitRows rows;
  for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
    int count = 0;
    for (SparseRows::InnerIterator it(matrix, r); it; ++it, ++count) {
      rows.column.push_back(static_cast<int32_t>(it.col()));
      rows.weight.push_back(it.value());
    }
    rows.count.push_back(count);
  }
  return rows;
}

SparseRows MatrixOf(const UnitRows& rows, Eigen::Index columns) {
  SparseRows matrix(static_cast<Eigen::Index>(rows.count.size()), columns);
  std::vector<Eigen::Triplet<double>> entries;
  size_t entry = 0;
  for (size_t r = 0; r < rows.count.size(); ++r) {
    for (int k = 0; k < rows.count[r]; ++k, ++entry) {
      entries.emplace_back(static_cast<int>(r), rows.column[entry], rows.weight[entry]);
    }
  }
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

void PutRows(const std::string& name, const UnitRows& rows, int bits, NpzArrays* arrays) {
  PackedUnitRows packed = PackUnitRows(rows, bits);
  (*arrays)[name + "_count"] = std::move(packed.count);
  (*arrays)[name + "_column"] = std::move(packed.column);
  (*arrays)[name + "_weight"] = std::move(packed.weight);
}

/// Reads the members of a compact file; errors name file and member.
class CompactBodyReader {
 public:
  CompactBodyReader(const NpzArrays& arrays, const std::string& where) : arrays_(arrays), where_(where) {}

  [[nodiscard]] bool Has(const std::string& name) const { return arrays_.count(name) > 0; }
  [[nodiscard]] const NdArray& Array(const std::string& name) const { return RequireArray(arrays_, name, where_); }
  [[nodiscard]] std::string Where(const std::string& name) const { return where_ + ": '" + name + "'"; }
  [[noreturn]] void Fail(const std::string& name, const std::string& message) const {
    throw std::runtime_error(Where(name) + ": " + message);
  }
  [[nodiscard]] Integers Packed(const std::string& name, int64_t expected) const {
    return UnpackIntegers(Array(name), expected, Where(name));
  }
  [[nodiscard]] std::vector<std::string> Texts(const std::string& name) const {
    const NdArray& array = Array(name);
    if (!array.is_text()) Fail(name, "expected text");
    std::vector<std::string> texts = array.ToStrings();
    if (!std::all_of(texts.begin(), texts.end(), IsOneLine)) Fail(name, "control characters");
    return texts;
  }
  [[nodiscard]] std::vector<double> Numbers(const std::string& name, int64_t expected) const {
    const NdArray& array = Array(name);
    if (!array.is_number() || array.shape.size() != 1 || (expected >= 0 && array.shape[0] != expected)) {
      Fail(name, "expected " + (expected >= 0 ? std::to_string(expected) : "a list of") + " numbers");
    }
    std::vector<double> values = array.ToDoubles();
    for (const double x : values) {
      if (!std::isfinite(x)) Fail(name, "NaN or infinite values");
    }
    return values;
  }
  [[nodiscard]] UnitRows Rows(const std::string& name, int bits, int64_t rows, int64_t columns) const {
    return UnpackUnitRows({Array(name + "_count"), Array(name + "_column"), Array(name + "_weight")}, bits, rows,
                          columns, Where(name));
  }

 private:
  const NpzArrays& arrays_;
  const std::string& where_;
};

void PutSurface(const BodyModelData& body, NpzArrays* out) {
  const auto U = static_cast<int>(body.vt.rows());
  if (U > 0 && body.ft.rows() > 0) {
    const MeshPredictor predictor(U, body.ft);
    (*out)["vt"] = PackIntegers(predictor.Residuals(GridValues(body.vt, kUvGrid, "vt"), 2));
    if (body.face_iuv.rows() > 0) {
      // One pair per UV vertex is enough if all corners of each UV vertex have the same in-part coordinates.
      const Integers corners = GridValues(body.face_iuv, kUvGrid, "face_iuv");
      Integers by_vertex(2 * static_cast<size_t>(U), 0);
      std::vector<bool> known(U, false);
      bool consistent = true;
      for (Eigen::Index i = 0; i < body.ft.size() && consistent; ++i) {
        const int u = body.ft.data()[i];
        for (int c = 0; c < 2; ++c) {
          int32_t& value = by_vertex[2 * static_cast<size_t>(u) + c];
          if (known[u] && value != corners[2 * i + c]) consistent = false;
          value = corners[2 * i + c];
        }
        known[u] = true;
      }
      if (consistent) (*out)["vt_iuv"] = PackIntegers(predictor.Residuals(by_vertex, 2));
    }
  }
  if (body.face_iuv.rows() > 0 && out->count("vt_iuv") == 0) {
    (*out)["face_iuv"] = PackIntegers(GridValues(body.face_iuv, kUvGrid, "face_iuv"));
  }
  if (!body.face_part.empty()) {
    (*out)["face_part"] = NdArray::FromUInt8(body.face_part.data(), {static_cast<int64_t>(body.face_part.size())});
  }
}

void ReadSurface(const CompactBodyReader& in, const std::vector<double>& lags, BodyModelData* body) {
  const int64_t F = body->faces.rows();
  if (in.Has("vt") && in.Has("ft")) {
    const NdArray& packed = in.Array("vt");
    const int64_t U = packed.shape.size() == 2 ? packed.shape[1] / 2 : 0;
    body->ft = UnpackFaces(in.Array("ft"), static_cast<int>(lags[1]), U, F, in.Where("ft"));
    const MeshPredictor predictor(static_cast<int>(U), body->ft);
    body->vt = FromGrid<MatrixX2f>(predictor.Restore(in.Packed("vt", 2 * U), 2, in.Where("vt")), U, 2, kUvGrid);
    if (in.Has("vt_iuv")) {
      const MatrixX2f iuv =
          FromGrid<MatrixX2f>(predictor.Restore(in.Packed("vt_iuv", 2 * U), 2, in.Where("vt_iuv")), U, 2, kUvGrid);
      body->face_iuv.resize(F, 6);
      for (Eigen::Index f = 0; f < F; ++f) {
        for (int c = 0; c < 3; ++c) body->face_iuv.block<1, 2>(f, 2 * c) = iuv.row(body->ft(f, c));
      }
    }
  }
  if (in.Has("face_iuv")) {
    body->face_iuv = FromGrid<RowMatrixXf>(in.Packed("face_iuv", 6 * F), F, 6, kUvGrid);
  }
  if (in.Has("face_part")) {
    const NdArray& parts = in.Array("face_part");
    if (parts.dtype != DType::kU8 || parts.num_elements() != F) in.Fail("face_part", "expected one byte a face");
    body->face_part.assign(parts.bytes.begin(), parts.bytes.end());
    for (const uint8_t part : body->face_part) {
      if (part > 24) in.Fail("face_part", Concatenate("part ", static_cast<int>(part), ", expected 0..24"));
    }
  }
}

}  // namespace

bool IsCompactBody(const NpzArrays& arrays) { return arrays.count("format") > 0; }

NpzArrays CompactFromBody(const BodyModelData& body) {
  const auto V = static_cast<int>(body.v_template.rows());
  const auto B = static_cast<int>(body.shapedirs.cols());
  NpzArrays out;
  out["format"] = NdArray::FromString(kCompactFormat);
  out["name"] = NdArray::FromString(body.name);
  if (!body.joint_names.empty()) out["joint_names"] = NdArray::FromStrings(body.joint_names);
  out["parents"] = NdArray::FromInts32(body.parents.data(), {static_cast<int64_t>(body.parents.size())});
  if (body.pose_mean.size() > 0)
    out["pose_mean"] = NdArray::FromDoubles(body.pose_mean.data(), {body.pose_mean.size()});

  const double pose_grid = PoseGrid(body.posedirs);
  const double grid[] = {kTemplateGrid, kShapeGrid, pose_grid};
  out["grid"] = NdArray::FromDoubles(grid, {3});
  const int32_t lag[] = {BestLag(body.faces), body.ft.rows() > 0 ? BestLag(body.ft) : 1};
  out["lag"] = NdArray::FromInts32(lag, {2});
  out["faces"] = PackFaces(body.faces, lag[0]);
  if (body.ft.rows() > 0) out["ft"] = PackFaces(body.ft, lag[1]);

  const MeshPredictor predictor(V, body.faces);
  out["v_template"] = PackIntegers(predictor.Residuals(GridValues(body.v_template, kTemplateGrid, "v_template"), 3));
  // Row 3v+c of shapedirs holds B values: 3B values a vertex.
  if (B > 0) {
    out["shapedirs"] = PackIntegers(predictor.Residuals(GridValues(body.shapedirs, kShapeGrid, "shapedirs"), 3 * B));
  }
  if (!body.posedirs.empty()) {
    PackedPoseCorrectives packed = PackPoseCorrectives(body.posedirs, predictor, pose_grid);
    out["posedirs_count"] = std::move(packed.count);
    out["posedirs_joint"] = std::move(packed.joint);
    out["posedirs_block"] = std::move(packed.block);
  }
  PutRows("weights", RowsOf(body.weights), kSkinningBits, &out);
  PutRows("regressor", RowsOf(body.J_regressor), kRegressorBits, &out);
  PutSurface(body, &out);
  if (!body.landmarks.empty()) {
    UnitRows rows;
    std::vector<std::string> names;
    for (const Landmark& landmark : body.landmarks) {
      names.push_back(landmark.name);
      rows.count.push_back(static_cast<int32_t>(landmark.vertices.size()));
      rows.column.insert(rows.column.end(), landmark.vertices.begin(), landmark.vertices.end());
      rows.weight.insert(rows.weight.end(), landmark.weights.begin(), landmark.weights.end());
    }
    out["landmark_names"] = NdArray::FromStrings(names);
    PutRows("landmark", rows, kRegressorBits, &out);
  }
  return out;
}

BodyModelData BodyFromCompact(const NpzArrays& arrays, const std::string& where, const LoadBodyOptions& options) {
  const CompactBodyReader in(arrays, where);
  const std::vector<std::string> format = in.Texts("format");
  if (format.size() != 1 || format[0] != kCompactFormat) {
    in.Fail("format",
            Concatenate("'", format.empty() ? "" : PrintableText(format[0]), "', expected '", kCompactFormat, "'"));
  }
  BodyModelData body;
  const std::vector<std::string> name = in.Texts("name");
  if (!name.empty()) body.name = name[0];
  if (in.Has("joint_names")) body.joint_names = in.Texts("joint_names");
  for (const double parent : in.Numbers("parents", -1)) {
    if (std::abs(parent) > 1e6) in.Fail("parents", "a joint number out of range");
    body.parents.push_back(static_cast<int>(parent));
  }
  const auto J = static_cast<int64_t>(body.parents.size());
  if (in.Has("pose_mean") && !options.flat_hand_mean) {
    const std::vector<double> mean = in.Numbers("pose_mean", 3 * J);
    body.pose_mean = Eigen::Map<const Eigen::VectorXd>(mean.data(), 3 * J);
  }
  const std::vector<double> grid = in.Numbers("grid", 3), lag = in.Numbers("lag", 2);
  for (const double step : grid) {
    if (!(step > 0 && step < 1)) in.Fail("grid", Concatenate("a step of ", step, ", expected one between 0 and 1"));
  }
  for (const double x : lag) {
    if (x != 1 && x != 2 && x != 8) in.Fail("lag", Concatenate(x, ", expected 1, 2 or 8"));
  }

  Integers vertices = in.Packed("v_template", -1);
  if (vertices.empty() || vertices.size() % 3 != 0) in.Fail("v_template", "expected three values a vertex");
  const auto V = static_cast<int64_t>(vertices.size() / 3);
  body.faces = UnpackFaces(in.Array("faces"), static_cast<int>(lag[0]), V, -1, in.Where("faces"));
  const MeshPredictor predictor(static_cast<int>(V), body.faces);
  body.v_template =
      FromGrid<MatrixX3d>(predictor.Restore(std::move(vertices), 3, in.Where("v_template")), V, 3, grid[0]);
  body.shapedirs.resize(3 * V, 0);
  if (in.Has("shapedirs")) {
    Integers shape = in.Packed("shapedirs", -1);
    const int64_t B = static_cast<int64_t>(shape.size()) / (3 * V);
    if (B < 1 || B > 10000 || static_cast<int64_t>(shape.size()) != 3 * V * B) {
      in.Fail("shapedirs", Concatenate(shape.size(), " values, expected a multiple of 3V = ", 3 * V));
    }
    body.shapedirs = FromGrid<RowMatrixXf>(
        predictor.Restore(std::move(shape), static_cast<int>(3 * B), in.Where("shapedirs")), 3 * V, B, grid[1]);
    if (options.max_betas > 0 && B > options.max_betas) {
      body.shapedirs = RowMatrixXf(body.shapedirs.leftCols(options.max_betas));
    }
  }
  if (in.Has("posedirs_block")) {
    body.posedirs =
        UnpackPoseCorrectives({in.Array("posedirs_count"), in.Array("posedirs_joint"), in.Array("posedirs_block")},
                              predictor, V, J, grid[2], in.Where("posedirs"));
  }
  body.weights = MatrixOf(in.Rows("weights", kSkinningBits, V, J), J);
  body.J_regressor = MatrixOf(in.Rows("regressor", kRegressorBits, J, V), V);
  ReadSurface(in, lag, &body);
  if (in.Has("landmark_names")) {
    const std::vector<std::string> names = in.Texts("landmark_names");
    const UnitRows rows = in.Rows("landmark", kRegressorBits, static_cast<int64_t>(names.size()), V);
    size_t entry = 0;
    for (size_t i = 0; i < names.size(); ++i) {
      Landmark landmark{names[i], {}, {}};
      for (int k = 0; k < rows.count[i]; ++k, ++entry) {
        landmark.vertices.push_back(rows.column[entry]);
        landmark.weights.push_back(rows.weight[entry]);
      }
      body.landmarks.push_back(std::move(landmark));
    }
  }
  return body;
}

}  // namespace bodyloom
