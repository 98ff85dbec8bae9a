// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/learning/adam.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "render/gaussian_avatar/learning/adam_simd.h"

namespace bodyloom {
namespace {

using avatar_internal::kAdamBeta1;
using avatar_internal::kAdamBeta2;

constexpr int kAdamRows = 4096;     ///< per task
constexpr int kBiasedSteps = 2400;  ///< beyond these 1 − βⁿ is 1 in float

struct AdamUnbias {
  std::array<float, kBiasedSteps> first{}, second{};
  AdamUnbias() {
    for (int n = 1; n <= kBiasedSteps; ++n) {
      first[n - 1] = static_cast<float>(1 / (1 - std::pow(static_cast<double>(kAdamBeta1), n)));
      second[n - 1] = static_cast<float>(1 / std::sqrt(1 - std::pow(static_cast<double>(kAdamBeta2), n)));
    }
  }
};

}  // namespace

void AdamState::Reset(int num_columns, int num_rows) {
  first.Resize(num_columns, num_rows);
  second.Resize(num_columns, num_rows);
  first.Fill(0);
  second.Fill(0);
  steps.assign(num_rows, 0);
}

void AdamState::Forget(int row) {
  for (int c = 0; c < first.columns(); ++c) first(row, c) = second(row, c) = 0;
  steps[row] = 0;
}

void AdamStep(const FloatColumns& gradient, std::span<const float> rates, std::span<const uint8_t> moves,
              int num_threads, AdamState* state, FloatColumns* values) {
  static const AdamUnbias unbias;
  const int rows = values->rows(), columns = values->columns();
  const auto fits = [&](const FloatColumns& table) { return table.rows() == rows && table.columns() == columns; };
  BODYLOOM_CHECK(fits(gradient) && fits(state->first) && fits(state->second) &&
                     static_cast<int>(state->steps.size()) == rows && static_cast<int>(moves.size()) == rows &&
                     static_cast<int>(rates.size()) == columns,
                 "Adam: tables of different sizes: values ", rows, "x", columns, ", derivatives ", gradient.rows(), "x",
                 gradient.columns(), ", ", moves.size(), " flags, ", rates.size(), " rates");
  ParallelFor((rows + kAdamRows - 1) / kAdamRows, num_threads, [&](int task) {
    alignas(64) std::array<float, kAdamRows> flags{}, unbias1{}, unbias2{};
    const int begin = task * kAdamRows, end = std::min(rows, begin + kAdamRows);
    for (int i = begin; i < end; ++i) {
      int32_t& n = state->steps[i];
      if (moves[i] != 0) n = std::min(n + 1, kBiasedSteps);
      flags[i - begin] = moves[i] != 0 ? 1 : 0;
      unbias1[i - begin] = n > 0 ? unbias.first[n - 1] : 1;
      unbias2[i - begin] = n > 0 ? unbias.second[n - 1] : 1;
    }
    // Spare rows are processed with flags of 0.
    const int whole = (end - begin + FloatColumns::kLanes - 1) / FloatColumns::kLanes * FloatColumns::kLanes;
    for (int c = 0; c < columns; ++c) {
      if (rates[c] == 0) continue;
      avatar_internal::StepAdamColumn(
          {gradient.column(c) + begin, flags.data(), unbias1.data(), unbias2.data(), state->first.column(c) + begin,
           state->second.column(c) + begin, values->column(c) + begin, rates[c]},
          0, whole);
    }
  });
}

}  // namespace bodyloom
