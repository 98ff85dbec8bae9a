// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/learning/adam.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/render/splat/same_bytes.h"

namespace bodyloom::adam_test {
namespace {

FloatColumns RandomTable(int columns, int rows, uint32_t seed) {
  std::mt19937 generator(seed);
  FloatColumns table(columns, rows);
  for (int c = 0; c < columns; ++c) {
    for (float& value : table.values(c)) value = static_cast<float>(generator() / 2147483648.0 - 1);
  }
  return table;
}

TEST(Adam, IsTheFormulaInDouble) {
  constexpr int kRows = 5000;
  AdamState state;
  state.Reset(2, kRows);
  FloatColumns values = RandomTable(2, kRows, 1);
  const FloatColumns begin = values;
  std::vector<double> m(2 * kRows), v(2 * kRows), x(2 * kRows);
  std::vector<int> n(kRows);
  for (int c = 0; c < 2; ++c) {
    for (int i = 0; i < kRows; ++i) x[c * kRows + i] = values(i, c);
  }
  const float rates[2] = {0.01F, 0};
  for (int step = 0; step < 12; ++step) {
    const FloatColumns gradient = RandomTable(2, kRows, 10 + step);
    std::vector<uint8_t> moves(kRows);
    for (int i = 0; i < kRows; ++i) moves[i] = (i + step) % 3 != 0;
    AdamStep(gradient, rates, moves, 1, &state, &values);
    for (int i = 0; i < kRows; ++i) {
      if (moves[i] == 0) continue;
      ++n[i];
      const double g = gradient(i, 0);
      m[i] += 0.1 * (g - m[i]), v[i] += 0.01 * (g * g - v[i]);
      x[i] -= 0.01 * m[i] / (1 - std::pow(0.9, n[i])) / std::sqrt(v[i] / (1 - std::pow(0.99, n[i])));
    }
  }
  for (int i = 0; i < kRows; ++i) {
    EXPECT_NEAR(values(i, 0), x[i], 1e-5) << i;
    EXPECT_EQ(values(i, 1), begin(i, 1)) << "a column of rate 0 moved";
    EXPECT_EQ(state.steps[i], n[i]);
  }
}

TEST(Adam, TheFirstStepIsTheRateWhateverTheDerivative) {
  AdamState state;
  state.Reset(1, 3);
  FloatColumns values(1, 3), gradient(1, 3);
  gradient(0, 0) = 1e-9F, gradient(1, 0) = -1e6F, gradient(2, 0) = 0;
  const float rate = 0.5F;
  AdamStep(gradient, {&rate, 1}, std::vector<uint8_t>(3, 1), 1, &state, &values);
  EXPECT_NEAR(values(0, 0), -0.5, 1e-4);
  EXPECT_NEAR(values(1, 0), 0.5, 1e-4);
  EXPECT_EQ(values(2, 0), 0);
}

TEST(Adam, ForgottenRowsBeginAnew) {
  AdamState state;
  state.Reset(1, 2);
  FloatColumns values(1, 2), gradient(1, 2);
  gradient(0, 0) = gradient(1, 0) = 1;
  const float rate = 0.1F;
  for (int k = 0; k < 5; ++k) AdamStep(gradient, {&rate, 1}, std::vector<uint8_t>(2, 1), 1, &state, &values);
  state.Forget(1);
  EXPECT_EQ(state.steps[1], 0);
  gradient(0, 0) = gradient(1, 0) = -1;
  const float kept = values(1, 0), carried = values(0, 0);
  AdamStep(gradient, {&rate, 1}, std::vector<uint8_t>(2, 1), 1, &state, &values);
  EXPECT_NEAR(values(1, 0), kept + 0.1, 1e-5);
  EXPECT_LT(values(0, 0), carried) << "the other one has its momentum still";
}

TEST(Adam, SameBytesForAnyThreadsAndInstructionSet) {
  const FloatColumns gradient = RandomTable(3, 9001, 2), begin = RandomTable(3, 9001, 3);
  const float rates[3] = {0.1F, 0.2F, 0.3F};
  std::vector<uint8_t> moves(9001);
  for (size_t i = 0; i < moves.size(); ++i) moves[i] = i % 4 != 0;
  ExpectSameBytesEverywhere([&](int threads, FloatColumns* table) {
    AdamState state;
    state.Reset(3, 9001);
    *table = begin;
    for (int k = 0; k < 3; ++k) AdamStep(gradient, rates, moves, threads, &state, table);
  });
}

TEST(Adam, RefusesTablesOfOtherSizes) {
  AdamState state;
  state.Reset(1, 3);
  FloatColumns values(1, 3), gradient(1, 4);
  const float rate = 1;
  EXPECT_THROW(AdamStep(gradient, {&rate, 1}, std::vector<uint8_t>(3, 1), 1, &state, &values), std::invalid_argument);
  EXPECT_THROW(AdamStep(values, {&rate, 1}, std::vector<uint8_t>(2, 1), 1, &state, &values), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::adam_test
