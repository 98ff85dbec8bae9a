// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body_making/left_half_arrays.h"

#include <cmath>
#include <stdexcept>

#include "data_tools/formats/npz.h"
#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr char kLeftHalfFormat[] = "bodyloom built-in body 1";
constexpr double kWeightUnit = 1.0 / 65535;  // of `weight`: a row sums to 65535
constexpr double kChartUnit = 1.0 / 65534;   // of `chart_uv`: even, so that the middle of a chart is exact
constexpr double kSumTolerance = 1e-3;
constexpr double kMaxShape_m = 10;
constexpr int64_t kMaxComponents = 1000;
constexpr size_t kMaxFileBytes = size_t{1} << 28;

class LeftHalfReader {
 public:
  LeftHalfReader(const std::string& npz_bytes, const std::string& where)
      : where_(where), arrays_(ReadNpzBytes(npz_bytes, where, kMaxFileBytes)) {
    const std::vector<std::string> format = Text("format");
    if (format.size() != 1 || format[0] != kLeftHalfFormat) {
      Fail("format", "'" + PrintableText(format.empty() ? "" : format[0]) + "'",
           std::string("'") + kLeftHalfFormat + "'");
    }
  }

  [[noreturn]] void Fail(const std::string& name, const std::string& found, const std::string& expected) const {
    throw std::runtime_error(where_ + ": " + name + ": found " + found + ", expected " + expected);
  }

  const NdArray& Numbers(const std::string& name, const std::vector<int64_t>& shape) const {
    const NdArray& array = RequireArray(arrays_, name, where_);
    bool fits = array.is_number() && array.shape.size() == shape.size();
    for (size_t i = 0; fits && i < shape.size(); ++i) fits = shape[i] < 0 || array.shape[i] == shape[i];
    if (!fits) {
      std::string wanted;
      for (int64_t n : shape) wanted += (wanted.empty() ? "" : "x") + (n < 0 ? std::string("n") : std::to_string(n));
      Fail(name, array.is_number() ? array.ShapeText() : "text", "numbers of shape " + wanted);
    }
    return array;
  }

  /// Whole numbers within [low, high].
  std::vector<int64_t> Ints(const std::string& name, const std::vector<int64_t>& shape, int64_t low,
                            int64_t high) const {
    const NdArray& array = Numbers(name, shape);
    if (array.dtype == DType::kF16 || array.dtype == DType::kF32 || array.dtype == DType::kF64) {
      Fail(name, "floating-point numbers", "integers");
    }
    std::vector<int64_t> values = array.ToInts();
    for (int64_t value : values) {
      if (value < low || value > high) {
        Fail(name, std::to_string(value), std::to_string(low) + ".." + std::to_string(high));
      }
    }
    return values;
  }

  /// Finite numbers within ±limit.
  std::vector<double> Reals(const std::string& name, const std::vector<int64_t>& shape, double limit) const {
    std::vector<double> values = Numbers(name, shape).ToDoubles();
    for (double value : values) {
      if (!(std::abs(value) <= limit)) Fail(name, std::to_string(value), "a number within +-" + std::to_string(limit));
    }
    return values;
  }

  std::vector<std::string> Text(const std::string& name) const {
    const NdArray& array = RequireArray(arrays_, name, where_);
    if (array.is_number()) Fail(name, "numbers", "text");
    return array.ToStrings();
  }

  /// Row lengths whose sum is the number of entries; returns that sum.
  std::vector<int64_t> Counts(const std::string& name, int64_t rows, int64_t max_count, int64_t* total) const {
    std::vector<int64_t> counts = Ints(name, {rows}, 0, max_count);
    *total = 0;
    for (int64_t count : counts) *total += count;
    return counts;
  }

 private:
  std::string where_;
  NpzArrays arrays_;
};

/// Rows of (index, weight), each summing to 1. `name` is the array of the weights.
std::vector<WeightedIndices> SparseRowsOf(const LeftHalfReader& reader, const std::string& name,
                                          const std::vector<int64_t>& counts, const std::vector<int64_t>& indices,
                                          const std::vector<double>& weights) {
  std::vector<WeightedIndices> rows(counts.size());
  size_t i = 0;
  for (size_t r = 0; r < counts.size(); ++r) {
    double sum = 0;
    for (int64_t k = 0; k < counts[r]; ++k, ++i) {
      rows[r].push_back({static_cast<int>(indices[i]), weights[i]});
      sum += weights[i];
    }
    if (!(std::abs(sum - 1) <= kSumTolerance)) {
      reader.Fail(name, "a sum of " + std::to_string(sum) + " in row " + std::to_string(r), "rows that sum to 1");
    }
  }
  return rows;
}

Eigen::MatrixXd ReadCageShape(const LeftHalfReader& reader, const LeftHalfSizes& sizes) {
  const NdArray& array = reader.Numbers("cage_shape", {-1, sizes.cage_vertices, 3});
  const int64_t components = array.shape[0];
  if (components > kMaxComponents)
    reader.Fail("cage_shape", std::to_string(components) + " components", "at most 1000");
  const std::vector<double> values = reader.Reals("cage_shape", {-1, sizes.cage_vertices, 3}, kMaxShape_m);
  Eigen::MatrixXd shape(sizes.cage_vertices, 3 * components);
  size_t i = 0;
  for (int64_t b = 0; b < components; ++b) {
    for (int v = 0; v < sizes.cage_vertices; ++v) {
      for (int c = 0; c < 3; ++c) shape(v, 3 * b + c) = values[i++];
    }
  }
  return shape;
}

void ReadCorrectives(const LeftHalfReader& reader, const LeftHalfSizes& sizes, LeftHalfArrays* arrays) {
  int64_t total = 0;
  const auto counts = reader.Counts("corrective_count", sizes.left_vertices, sizes.joints, &total);
  const auto joints = reader.Ints("corrective_joint", {total}, 1, sizes.joints - 1);
  const auto blocks = reader.Ints("corrective_block", {total, 27}, INT16_MIN, INT16_MAX);
  arrays->correctives.resize(counts.size());
  size_t block = 0;
  for (size_t v = 0; v < counts.size(); ++v) {
    for (int64_t k = 0; k < counts[v]; ++k, ++block) {
      CorrectiveBlock corrective;
      corrective.joint = static_cast<int>(joints[block]);
      if (k > 0 && corrective.joint <= arrays->correctives[v].back().joint) {
        reader.Fail("corrective_joint",
                    "joint " + std::to_string(corrective.joint) + " out of order at entry " + std::to_string(block),
                    "increasing joints for each vertex");
      }
      for (int i = 0; i < 27; ++i) {
        corrective.values[i] = static_cast<float>(kCorrectiveUnit_m * static_cast<double>(blocks[27 * block + i]));
      }
      arrays->correctives[v].push_back(corrective);
    }
  }
}

void ReadCharts(const LeftHalfReader& reader, const LeftHalfSizes& sizes, LeftHalfArrays* arrays) {
  const auto num_kinds = static_cast<int64_t>(ChartKinds().size());
  const std::vector<std::string> names = reader.Text("chart_names");
  for (size_t c = 0; c < ChartKinds().size(); ++c) {
    const std::string found = c < names.size() ? names[c] : "nothing";
    if (names.size() != ChartKinds().size() || found != ChartKinds()[c].name) {
      reader.Fail("chart_names", "'" + PrintableText(found) + "' at entry " + std::to_string(c),
                  std::string("'") + ChartKinds()[c].name + "' of " + std::to_string(num_kinds) + " charts");
    }
  }
  int64_t total = 0;
  const auto counts = reader.Counts("chart_count", num_kinds, sizes.left_vertices, &total);
  const auto uv = reader.Ints("chart_uv", {total, 2}, 0, 65534);
  arrays->charts.resize(ChartKinds().size());
  size_t i = 0;
  for (size_t c = 0; c < counts.size(); ++c) {
    for (int64_t k = 0; k < counts[c]; ++k, ++i) {
      arrays->charts[c].uv.emplace_back(kChartUnit * static_cast<double>(uv[2 * i]),
                                        kChartUnit * static_cast<double>(uv[2 * i + 1]));
    }
  }
  const auto placements = reader.Reals("atlas_from_chart", {NumChartIslands(), 2, 3}, 2);
  for (int island = 0; island < NumChartIslands(); ++island) {
    arrays->atlas_from_chart.emplace_back(
        Eigen::Map<const Eigen::Matrix<double, 2, 3, Eigen::RowMajor>>(&placements[6 * island]));
  }
}

}  // namespace

LeftHalfArrays ReadLeftHalfArrays(const std::string& npz_bytes, const std::string& where, const LeftHalfSizes& sizes) {
  const LeftHalfReader reader(npz_bytes, where);
  LeftHalfArrays arrays;
  arrays.cage_shape = ReadCageShape(reader, sizes);

  int64_t total = 0;
  const auto weight_counts = reader.Counts("weight_count", sizes.left_vertices, sizes.joints, &total);
  const auto weight_joints = reader.Ints("weight_joint", {total}, 0, sizes.joints - 1);
  std::vector<double> weights;
  for (int64_t weight : reader.Ints("weight", {total}, 0, 65535)) {
    weights.push_back(kWeightUnit * static_cast<double>(weight));
  }
  arrays.weights = SparseRowsOf(reader, "weight", weight_counts, weight_joints, weights);

  const auto regressor_counts = reader.Counts("regressor_count", sizes.left_joints, sizes.vertices, &total);
  arrays.regressor = SparseRowsOf(reader, "regressor_weight", regressor_counts,
                                  reader.Ints("regressor_vertex", {total}, 0, sizes.vertices - 1),
                                  reader.Reals("regressor_weight", {total}, 1));

  arrays.landmark_names = reader.Text("landmark_names");
  const auto landmark_counts =
      reader.Counts("landmark_count", static_cast<int64_t>(arrays.landmark_names.size()), sizes.vertices, &total);
  arrays.landmarks = SparseRowsOf(reader, "landmark_weight", landmark_counts,
                                  reader.Ints("landmark_vertex", {total}, 0, sizes.vertices - 1),
                                  reader.Reals("landmark_weight", {total}, 1));
  ReadCorrectives(reader, sizes, &arrays);
  ReadCharts(reader, sizes, &arrays);
  return arrays;
}

CorrectiveBlock MirrorCorrective(const CorrectiveBlock& block, int mirrored_joint) {
  CorrectiveBlock mirrored;
  mirrored.joint = mirrored_joint;
  for (int c = 0; c < 3; ++c) {
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        const bool negative = (c == 0) ^ (a == 0) ^ (b == 0);
        const int i = 9 * c + 3 * a + b;
        mirrored.values[i] = negative ? -block.values[i] : block.values[i];
      }
    }
  }
  return mirrored;
}

}  // namespace bodyloom
