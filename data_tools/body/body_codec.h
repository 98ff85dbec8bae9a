// SPDX-License-Identifier: Apache-2.0
/// Integer coding of compact body files: numbers on a grid, predicted from those already known, so that deflate only
/// has to code few, small residuals. All of it is exact integer arithmetic, the same on every machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "data_tools/formats/ndarray.h"
#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

using Integers = std::vector<int32_t>;

/// Integers as byte planes: zigzag (0, −1, 1, −2 … → 0, 1, 2, 3 …), then all lowest bytes, all second bytes, … in a
/// uint8 array planes×n with as few planes as needed.
NdArray PackIntegers(const Integers& values);

/// The inverse. Throws std::runtime_error "where: …" unless `array` is uint8 planes×n with 1 to 4 planes and, when
/// expected ≥ 0, n = expected.
Integers UnpackIntegers(const NdArray& array, int64_t expected, const std::string& where);

/// round(value / step). Throws std::invalid_argument naming `what` when the result leaves ±2^29.
int32_t OnGrid(double value, double step, const char* what);

/// Predicts a mesh vertex as the mean of its neighbours of lower index, or as the vertex before it if there is none. On
/// Catmull–Clark subdivided meshes this is close to the subdivision rule.
class MeshPredictor {
 public:
  /// Triangle indices must lie in 0..num_vertices−1.
  MeshPredictor(int num_vertices, const MatrixX3i& faces);

  /// Vertices that come before v and share an edge with it.
  [[nodiscard]] const int* begin(int v) const { return lower_.data() + begin_[v]; }
  [[nodiscard]] const int* end(int v) const { return lower_.data() + begin_[v + 1]; }

  /// Converts `columns` values per vertex to residuals and back. Restore throws std::runtime_error "where: …" when a
  /// value leaves the range of OnGrid.
  [[nodiscard]] Integers Residuals(const Integers& values, int columns) const;
  [[nodiscard]] Integers Restore(Integers residuals, int columns, const std::string& where) const;

 private:
  void Predict(const Integers& values, int columns, int v, std::vector<int64_t>* prediction) const;
  std::vector<int> begin_, lower_;
};

/// round(sum / count), halves upwards; count > 0.
int64_t RoundedMean(int64_t sum, int64_t count);

/// The value as an OnGrid integer, or std::runtime_error.
int32_t CheckedInteger(int64_t value, const std::string& where);

/// Rows of weights that each sum to 1 (skinning, regressors, landmarks).
struct UnitRows {
  Integers count;              ///< entries of each row, at least 1
  Integers column;             ///< of every entry
  std::vector<double> weight;  ///< of every entry, a multiple of 2^−bits after PackUnitRows
};

/// Rounds every row to multiples of 2^−bits so that it sums to exactly 1 (largest remainders), and packs it: counts,
/// column differences within the row, and all weights but each row's last.
struct PackedUnitRows {
  NdArray count, column, weight;
};
PackedUnitRows PackUnitRows(const UnitRows& rows, int bits);
/// The inverse. Columns must lie in 0..num_columns−1. Throws std::runtime_error "where: …".
UnitRows UnpackUnitRows(const PackedUnitRows& packed, int bits, int64_t num_rows, int64_t num_columns,
                        const std::string& where);

// Triangles of a compact body file: each index as the difference to that of the face `lag` faces before, because
// meshes are numbered regularly (lag 1: previous triangle; 2: previous quad; 8: the same quad of the previous
// subdivided face).

NdArray PackFaces(const MatrixX3i& faces, int lag);

/// The lag, out of 1, 2 and 8, whose differences compress best.
int BestLag(const MatrixX3i& faces);

/// The inverse of PackFaces; every index must lie in 0..limit−1 and, when expected_faces >= 0, their number fit. Throws
/// std::runtime_error "where: …".
MatrixX3i UnpackFaces(const NdArray& packed, int lag, int64_t limit, int64_t expected_faces, const std::string& where);

// Pose correctives of a compact body file: blocks on a grid, predicted from the same joint's blocks at neighbouring
// vertices. Layout and error bound in body_compact.h.

struct PackedPoseCorrectives {
  NdArray count;  ///< blocks of each vertex
  NdArray joint;  ///< joint of each block, as the difference to the vertex's block before it
  NdArray block;  ///< 27 residuals of each block
};

/// Step of the grid of the stored blocks: a decimal one if they lie on it exactly, else a power of two
/// (body_compact.h).
double PoseGrid(const PoseCorrectives& posedirs);

PackedPoseCorrectives PackPoseCorrectives(const PoseCorrectives& posedirs, const MeshPredictor& predictor, double step);

/// The inverse for V vertices and J joints. Throws std::runtime_error "where: …".
PoseCorrectives UnpackPoseCorrectives(const PackedPoseCorrectives& packed, const MeshPredictor& predictor, int64_t V,
                                      int64_t J, double step, const std::string& where);

}  // namespace bodyloom
