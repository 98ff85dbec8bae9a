// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/body/body_posedirs_codec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
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
