// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body/body_codec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "data_tools/formats/zip.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr int64_t kLimit = int64_t{1} << 29;

uint32_t ZigZag(int32_t x) { return (static_cast<uint32_t>(x) << 1) ^ (x < 0 ? ~uint32_t{0} : 0); }
/// Whole numbers in proportion to `weights` that sum to `unit`: rounded down, the rest to the largest remainders.
std::vector<int64_t> SharesOf(int64_t unit, const double* weights, int count) {
  const double sum = std::accumulate(weights, weights + count, 0.0);
  BODYLOOM_CHECK(count > 0 && std::abs(sum - 1) < 1e-3, "a row of weights sums to ", sum, ", expected 1");
  std::vector<int64_t> shares(count);
  std::vector<std::pair<double, int>> order(count);  // most negative first: rounded down furthest
  int64_t missing = unit;
  for (int k = 0; k < count; ++k) {
    const double exact = weights[k] / sum * static_cast<double>(unit);
    shares[k] = static_cast<int64_t>(std::floor(exact));
    order[k] = {static_cast<double>(shares[k]) - exact, k};
    missing -= shares[k];
  }
  std::sort(order.begin(), order.end());
  for (int64_t k = 0; k < missing; ++k) ++shares[order[k % count].second];
  return shares;
}

int32_t UnZigZag(uint32_t x) { return static_cast<int32_t>((x >> 1) ^ (~(x & 1) + 1)); }

}  // namespace

NdArray PackIntegers(const Integers& values) {
  uint32_t all = 0;
  for (const int32_t x : values) all |= ZigZag(x);
  int planes = 1;
  while (planes < 4 && (all >> (8 * planes)) != 0) ++planes;
  const size_t n = values.size();
  std::vector<uint8_t> bytes(n * static_cast<size_t>(planes));
  for (int p = 0; p < planes; ++p) {
    for (size_t i = 0; i < n; ++i) bytes[p * n + i] = static_cast<uint8_t>(ZigZag(values[i]) >> (8 * p));
  }
  return NdArray::FromUInt8(bytes.data(), {planes, static_cast<int64_t>(n)});
}

Integers UnpackIntegers(const NdArray& array, int64_t expected, const std::string& where) {
  if (array.dtype != DType::kU8 || array.shape.size() != 2 || array.shape[0] < 1 || array.shape[0] > 4 ||
      (expected >= 0 && array.shape[1] != expected)) {
    throw std::runtime_error(Concatenate(where, ": ", array.ShapeText(), ", expected 1..4 byte planes of ",
                                         expected >= 0 ? std::to_string(expected) : "n", " values"));
  }
  const auto n = static_cast<size_t>(array.shape[1]);
  Integers values(n);
  for (size_t i = 0; i < n; ++i) {
    uint32_t x = 0;
    for (int64_t p = 0; p < array.shape[0]; ++p) {
      x |= static_cast<uint32_t>(static_cast<unsigned char>(array.bytes[p * n + i])) << (8 * p);
    }
    values[i] = UnZigZag(x);
  }
  return values;
}

int32_t OnGrid(double value, double step, const char* what) {
  const double q = std::nearbyint(value / step);
  BODYLOOM_CHECK(std::abs(q) < static_cast<double>(kLimit), what, " holds ", value,
                 ", too large to be stored in steps of ", step);
  return static_cast<int32_t>(q);
}

int64_t RoundedMean(int64_t sum, int64_t count) {
  const int64_t numerator = 2 * sum + count, denominator = 2 * count;
  const int64_t quotient = numerator / denominator;
  return numerator % denominator < 0 ? quotient - 1 : quotient;
}

int32_t CheckedInteger(int64_t value, const std::string& where) {
  if (value <= -kLimit || value >= kLimit)
    throw std::runtime_error(where + ": a value out of range, the file is damaged");
  return static_cast<int32_t>(value);
}

MeshPredictor::MeshPredictor(int num_vertices, const MatrixX3i& faces) : begin_(num_vertices + 1, 0) {
  const auto each_edge = [&faces](const auto& use) {
    for (Eigen::Index f = 0; f < faces.rows(); ++f) {
      for (int c = 0; c < 3; ++c) {
        const int a = faces(f, c), b = faces(f, (c + 1) % 3);
        if (a != b) use(std::min(a, b), std::max(a, b));
      }
    }
  };
  each_edge([this](int, int high) { ++begin_[high + 1]; });
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  lower_.resize(begin_.back());
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  each_edge([&](int low, int high) { lower_[next[high]++] = low; });
  int out = 0;  // an edge with two faces was counted twice: keep each neighbour once
  for (int v = 0; v < num_vertices; ++v) {
    const auto first = lower_.begin() + begin_[v], last = lower_.begin() + begin_[v + 1];
    std::sort(first, last);
    begin_[v] = out;
    for (auto it = first; it != last; ++it) {
      if (it == first || *it != *(it - 1)) lower_[out++] = *it;
    }
  }
  begin_[num_vertices] = out;
  lower_.resize(out);
}

void MeshPredictor::Predict(const Integers& values, int columns, int v, std::vector<int64_t>* prediction) const {
  prediction->assign(columns, 0);
  const auto count = end(v) - begin(v);
  if (count == 0) {
    if (v > 0) std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(v - 1) * columns, columns, prediction->begin());
    return;
  }
  for (const int* u = begin(v); u != end(v); ++u) {
    const int32_t* row = values.data() + static_cast<size_t>(*u) * columns;
    for (int c = 0; c < columns; ++c) (*prediction)[c] += row[c];
  }
  for (int64_t& x : *prediction) x = RoundedMean(x, count);
}

Integers MeshPredictor::Residuals(const Integers& values, int columns) const {
  const int n = static_cast<int>(begin_.size()) - 1;
  BODYLOOM_CHECK(values.size() == static_cast<size_t>(n) * columns, values.size(), " values for ", n, " vertices of ",
                 columns);
  Integers residuals(values.size());
  std::vector<int64_t> prediction;
  for (int v = 0; v < n; ++v) {
    Predict(values, columns, v, &prediction);
    for (int c = 0; c < columns; ++c) {
      const size_t i = static_cast<size_t>(v) * columns + c;
      residuals[i] = static_cast<int32_t>(values[i] - prediction[c]);
    }
  }
  return residuals;
}

Integers MeshPredictor::Restore(Integers residuals, int columns, const std::string& where) const {
  const int n = static_cast<int>(begin_.size()) - 1;
  BODYLOOM_CHECK(residuals.size() == static_cast<size_t>(n) * columns, residuals.size(), " residuals for ", n,
                 " vertices of ", columns);
  std::vector<int64_t> prediction;
  for (int v = 0; v < n; ++v) {
    Predict(residuals, columns, v, &prediction);
    for (int c = 0; c < columns; ++c) {
      const size_t i = static_cast<size_t>(v) * columns + c;
      residuals[i] = CheckedInteger(residuals[i] + prediction[c], where);
    }
  }
  return residuals;
}

PackedUnitRows PackUnitRows(const UnitRows& rows, int bits) {
  const int64_t unit = int64_t{1} << bits;
  Integers counts, columns, weights;
  size_t begin = 0;
  for (const int32_t count : rows.count) {
    const std::vector<int64_t> q = SharesOf(unit, rows.weight.data() + begin, count);
    // Shares of zero are dropped, so that packing what was unpacked changes nothing.
    int kept = 0;
    int32_t previous = 0;
    for (int k = 0; k < count; ++k) {
      if (q[k] == 0) continue;
      columns.push_back(rows.column[begin + k] - previous);
      previous = rows.column[begin + k];
      BODYLOOM_CHECK(std::abs(q[k]) < kLimit, "a row of weights holds ", rows.weight[begin + k],
                     ", too large to be stored");
      weights.push_back(static_cast<int32_t>(q[k]));
      ++kept;
    }
    weights.pop_back();  // the last follows from the sum
    counts.push_back(kept);
    begin += count;
  }
  return {PackIntegers(counts), PackIntegers(columns), PackIntegers(weights)};
}

UnitRows UnpackUnitRows(const PackedUnitRows& packed, int bits, int64_t num_rows, int64_t num_columns,
                        const std::string& where) {
  const auto fail = [&](const std::string& message) { throw std::runtime_error(where + ": " + message); };
  UnitRows rows;
  rows.count = UnpackIntegers(packed.count, num_rows, where + " counts");
  int64_t total = 0;
  for (const int32_t count : rows.count) {
    if (count < 1 || count > num_columns) fail(Concatenate("a row of ", count, " entries, expected 1..", num_columns));
    total += count;
  }
  rows.column = UnpackIntegers(packed.column, total, where + " columns");
  const Integers weights = UnpackIntegers(packed.weight, total - num_rows, where + " weights");
  const int64_t unit = int64_t{1} << bits;
  size_t entry = 0, stored = 0;
  for (const int32_t count : rows.count) {
    int64_t column = 0, left = unit;
    for (int k = 0; k < count; ++k, ++entry) {
      column += rows.column[entry];
      if (column < 0 || column >= num_columns) {
        fail(Concatenate("column ", column, ", expected 0..", num_columns - 1));
      }
      rows.column[entry] = static_cast<int32_t>(column);
      const int64_t q = k + 1 < count ? weights[stored++] : left;
      left -= q;
      rows.weight.push_back(static_cast<double>(q) / static_cast<double>(unit));
    }
  }
  return rows;
}

NdArray PackFaces(const MatrixX3i& faces, int lag) {
  Integers residuals(faces.size());
  for (Eigen::Index i = 0; i < faces.size(); ++i) {
    residuals[i] = faces.data()[i] - (i >= 3 * lag ? faces.data()[i - 3 * lag] : 0);
  }
  return PackIntegers(residuals);
}

int BestLag(const MatrixX3i& faces) {
  int best = 1;
  size_t best_size = 0;
  for (const int lag : {1, 2, 8}) {
    const size_t size = MakeZip({{"f", PackFaces(faces, lag).bytes}}).size();
    if (best_size == 0 || size < best_size) {
      best = lag;
      best_size = size;
    }
  }
  return best;
}

MatrixX3i UnpackFaces(const NdArray& packed, int lag, int64_t limit, int64_t expected_faces, const std::string& where) {
  Integers values = UnpackIntegers(packed, expected_faces < 0 ? -1 : 3 * expected_faces, where);
  if (values.size() % 3 != 0) throw std::runtime_error(where + ": not a whole number of triangles");
  for (size_t i = 0; i < values.size(); ++i) {
    const int64_t before = i >= 3 * static_cast<size_t>(lag) ? values[i - 3 * static_cast<size_t>(lag)] : 0;
    const int64_t index = values[i] + before;
    if (index < 0 || index >= limit) {
      throw std::runtime_error(
          Concatenate(where, ": face ", i / 3, " names vertex ", index, ", expected 0..", limit - 1));
    }
    values[i] = static_cast<int32_t>(index);
  }
  return Eigen::Map<const MatrixX3i>(values.data(), static_cast<Eigen::Index>(values.size() / 3), 3);
}

namespace {

constexpr int kBlock = 27;

/// The block of `joint` at vertex v, or −1.
int FindBlock(const PoseCorrectives& posedirs, int v, int joint) {
  const auto first = posedirs.joint.begin() + posedirs.begin[v], last = posedirs.joint.begin() + posedirs.begin[v + 1];
  const auto it = std::find(first, last, joint);
  return it == last ? -1 : static_cast<int>(it - posedirs.joint.begin());
}

/// Mean of the joint's blocks at v's earlier neighbours; zero when none has one.
std::array<int64_t, kBlock> Predict(const PoseCorrectives& posedirs, const MeshPredictor& predictor,
                                    const Integers& values, int v, int joint) {
  std::array<int64_t, kBlock> sum{};
  int count = 0;
  for (const int* u = predictor.begin(v); u != predictor.end(v); ++u) {
    const int block = FindBlock(posedirs, *u, joint);
    if (block < 0) continue;
    for (int i = 0; i < kBlock; ++i) sum[i] += values[static_cast<size_t>(block) * kBlock + i];
    ++count;
  }
  if (count > 1) {
    for (int64_t& x : sum) x = RoundedMean(x, count);
  }
  return sum;
}

}  // namespace

double PoseGrid(const PoseCorrectives& posedirs) {
  for (const double step : {1e-4, 5e-5, 2e-5, 1e-5}) {
    const bool exact = std::all_of(posedirs.block.begin(), posedirs.block.end(), [step](float x) {
      return static_cast<float>(std::nearbyint(x / step) * step) == x;
    });
    if (exact) return step;
  }
  return 1.0 / (1 << 21);
}

PackedPoseCorrectives PackPoseCorrectives(const PoseCorrectives& posedirs, const MeshPredictor& predictor,
                                          double step) {
  Integers values, counts, joints, residuals;
  values.reserve(posedirs.block.size());
  for (const float x : posedirs.block) values.push_back(OnGrid(x, step, "posedirs"));
  residuals.reserve(values.size());
  const int V = static_cast<int>(posedirs.begin.size()) - 1;
  for (int v = 0; v < V; ++v) {
    counts.push_back(posedirs.begin[v + 1] - posedirs.begin[v]);
    for (int b = posedirs.begin[v]; b < posedirs.begin[v + 1]; ++b) {
      joints.push_back(posedirs.joint[b] - (b > posedirs.begin[v] ? posedirs.joint[b - 1] : 0));
      const std::array<int64_t, kBlock> prediction = Predict(posedirs, predictor, values, v, posedirs.joint[b]);
      for (int i = 0; i < kBlock; ++i) {
        residuals.push_back(static_cast<int32_t>(values[static_cast<size_t>(b) * kBlock + i] - prediction[i]));
      }
    }
  }
  return {PackIntegers(counts), PackIntegers(joints), PackIntegers(residuals)};
}

PoseCorrectives UnpackPoseCorrectives(const PackedPoseCorrectives& packed, const MeshPredictor& predictor, int64_t V,
                                      int64_t J, double step, const std::string& where) {
  PoseCorrectives posedirs;
  int64_t total = 0;
  posedirs.begin.push_back(0);
  for (const int32_t count : UnpackIntegers(packed.count, V, where + " counts")) {
    if (count < 0 || count >= J) {
      throw std::runtime_error(Concatenate(where, ": ", count, " blocks at a vertex, expected 0..", J - 1));
    }
    total += count;
    posedirs.begin.push_back(static_cast<int>(std::min<int64_t>(total, INT32_MAX)));
  }
  posedirs.joint = UnpackIntegers(packed.joint, total, where + " joints");
  Integers values = UnpackIntegers(packed.block, kBlock * total, where + " blocks");
  for (int v = 0; v < static_cast<int>(V); ++v) {
    int64_t joint = 0;
    for (int b = posedirs.begin[v]; b < posedirs.begin[v + 1]; ++b) {
      joint += posedirs.joint[b];
      if (joint < 1 || joint >= J) {
        throw std::runtime_error(Concatenate(where, ": a block of joint ", joint, ", expected 1..", J - 1));
      }
      posedirs.joint[b] = static_cast<int>(joint);
      const std::array<int64_t, kBlock> prediction = Predict(posedirs, predictor, values, v, posedirs.joint[b]);
      for (int i = 0; i < kBlock; ++i) {
        int32_t& value = values[static_cast<size_t>(b) * kBlock + i];
        value = CheckedInteger(value + prediction[i], where);
      }
    }
  }
  posedirs.block.reserve(values.size());
  for (const int32_t q : values) posedirs.block.push_back(static_cast<float>(q * step));
  return posedirs;
}

}  // namespace bodyloom
