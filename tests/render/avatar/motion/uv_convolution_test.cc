// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/avatar/motion/uv_convolution.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <stdexcept>

#include "tests/render/splat/same_bytes.h"

namespace bodyloom {
namespace {

using Numbers = std::mt19937;

float Between(Numbers* numbers) { return static_cast<float>((*numbers)() / 2147483648.0 - 1); }

TexelFeatures RandomFeatures(int side, int channels, Numbers* numbers) {
  TexelFeatures features(side, channels);
  for (int y = 0; y < side; ++y) {
    for (int i = 0; i < side * channels; ++i) features.at(y, 0)[i] = Between(numbers);
  }
  return features;
}

std::vector<float> RandomParameters(const UvConvolution& c, Numbers* numbers) {
  std::vector<float> parameters(c.num_parameters());
  for (float& p : parameters) p = Between(numbers);
  return parameters;
}

double Product(const TexelFeatures& a, const TexelFeatures& b) {
  double sum = 0;
  for (int y = 0; y < a.side(); ++y) {
    for (int i = 0; i < a.side() * a.channels(); ++i) sum += double(a.at(y, 0)[i]) * b.at(y, 0)[i];
  }
  return sum;
}

class ConvolutionOf : public testing::TestWithParam<UvConvolution> {};

TEST_P(ConvolutionOf, IsTheFormula) {
  const UvConvolution c = GetParam();
  Numbers numbers(1);
  const int side = 16;
  const TexelFeatures in = RandomFeatures(side, c.in_channels, &numbers);
  const std::vector<float> parameters = RandomParameters(c, &numbers);
  TexelFeatures out;
  Convolve(c, parameters, in, 2, &out);
  ASSERT_EQ(out.side(), side / c.stride);
  ASSERT_EQ(out.channels(), c.out_channels);
  for (int y = 0; y < out.side(); ++y) {
    for (int x = 0; x < out.side(); ++x) {
      for (int k = 0; k < c.out_channels; ++k) {
        double sum = parameters[c.num_weights() + k], size = std::abs(sum);
        for (int i = 0; i < c.size; ++i) {
          for (int j = 0; j < c.size; ++j) {
            const int from_y = c.stride * y + i - c.size / 2, from_x = c.stride * x + j - c.size / 2;
            if (from_y < 0 || from_y >= side || from_x < 0 || from_x >= side) continue;
            for (int n = 0; n < c.in_channels; ++n) {
              const double term = double(in.at(from_y, from_x)[n]) *
                                  parameters[((size_t(i) * c.size + j) * c.in_channels + n) * c.out_channels + k];
              sum += term, size += std::abs(term);
            }
          }
        }
        EXPECT_NEAR(out.at(y, x)[k], sum, 1e-6 * size) << y << " " << x << " " << k;
      }
    }
  }
}

// The convolution is linear in the input and in the parameters, so its derivatives are its adjoints: g · f(x) = f*(g) · x.
TEST_P(ConvolutionOf, DerivativesAreTheAdjoints) {
  UvConvolution c = GetParam();
  Numbers numbers(2);
  const TexelFeatures in = RandomFeatures(16, c.in_channels, &numbers);
  std::vector<float> parameters = RandomParameters(c, &numbers);
  TexelFeatures out;
  Convolve(c, parameters, in, 1, &out);
  const TexelFeatures by_out = RandomFeatures(out.side(), c.out_channels, &numbers);

  std::vector<float> by_parameters(parameters.size());
  ConvolveByParameters(c, in, by_out, 2, by_parameters);
  double by_all = 0;
  for (size_t i = 0; i < parameters.size(); ++i) by_all += double(by_parameters[i]) * parameters[i];
  EXPECT_NEAR(by_all, Product(by_out, out), 1e-3);

  std::fill(parameters.begin() + c.num_weights(), parameters.end(), 0.0F);
  Convolve(c, parameters, in, 1, &out);
  std::vector<float> scratch;
  TexelFeatures by_in, by_last;
  ConvolveByInput(c, parameters, by_out, 0, 2, &scratch, &by_in);
  ASSERT_EQ(by_in.side(), 16);
  EXPECT_NEAR(Product(by_in, in), Product(by_out, out), 1e-3);

  const int first = c.in_channels - 16;
  ConvolveByInput(c, parameters, by_out, first, 1, &scratch, &by_last);
  ASSERT_EQ(by_last.channels(), 16);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      for (int k = 0; k < 16; ++k) ASSERT_EQ(by_last.at(y, x)[k], by_in.at(y, x)[first + k]);
    }
  }
}

// One at a time, so that an error in one place is not hidden in a sum.
TEST_P(ConvolutionOf, DerivativeByAnInputIsWhatItReaches) {
  const UvConvolution c = GetParam();
  Numbers numbers(3);
  std::vector<float> parameters = RandomParameters(c, &numbers);
  std::fill(parameters.begin() + c.num_weights(), parameters.end(), 0.0F);
  const TexelFeatures by_out = RandomFeatures(16 / c.stride, c.out_channels, &numbers);
  std::vector<float> scratch;
  TexelFeatures by_in, out;
  ConvolveByInput(c, parameters, by_out, 0, 1, &scratch, &by_in);
  for (const auto& [y, x, k] : {std::array{0, 0, 0}, {0, 15, 3}, {15, 0, 7}, {15, 15, 9}, {7, 8, 1}, {8, 7, 15}}) {
    TexelFeatures one(16, c.in_channels);
    one.at(y, x)[k] = 1;
    Convolve(c, parameters, one, 1, &out);
    EXPECT_NEAR(by_in.at(y, x)[k], Product(by_out, out), 1e-4) << y << " " << x << " " << k;
  }
}

TEST_P(ConvolutionOf, SameBytesForAnyThreadsAndInstructionSet) {
  const UvConvolution c = GetParam();
  Numbers numbers(4);
  const TexelFeatures in = RandomFeatures(32, c.in_channels, &numbers);
  const std::vector<float> parameters = RandomParameters(c, &numbers);
  ExpectSameBytesEverywhere([&](int threads, FloatColumns* table) {
    TexelFeatures out, by_in;
    std::vector<float> by_parameters(parameters.size()), scratch;
    Convolve(c, parameters, in, threads, &out);
    ConvolveByParameters(c, in, out, threads, by_parameters);
    ConvolveByInput(c, parameters, out, 0, threads, &scratch, &by_in);
    table->Resize(2, int(parameters.size()));
    table->Fill(0);
    std::copy(by_parameters.begin(), by_parameters.end(), table->column(0));
    for (int y = 0; y < by_in.side(); ++y) {
      for (int i = 0; i < by_in.side() * by_in.channels(); ++i) {
        (*table)((y * 31 + i) % table->rows(), 1) += by_in.at(y, 0)[i];
      }
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Kernels, ConvolutionOf,
                         testing::Values(UvConvolution{16, 16, 3, 1}, UvConvolution{32, 48, 3, 1},
                                         UvConvolution{48, 32, 3, 2}, UvConvolution{32, 16, 1, 1}));

TEST(UvConvolution, RefusesWhatDoesNotFit) {
  TexelFeatures in(16, 16), out, narrow(16, 8), small(4, 16);
  const std::vector<float> parameters(UvConvolution{}.num_parameters());
  EXPECT_THROW(Convolve({16, 16, 5, 1}, parameters, in, 1, &out), std::invalid_argument);
  EXPECT_THROW(Convolve({16, 20, 3, 1}, parameters, in, 1, &out), std::invalid_argument);
  EXPECT_THROW(Convolve({}, parameters, narrow, 1, &out), std::invalid_argument);
  EXPECT_THROW(Convolve({}, parameters, small, 1, &out), std::invalid_argument);
  EXPECT_THROW(Convolve({}, std::span(parameters).first(10), in, 1, &out), std::invalid_argument);
  std::vector<float> scratch;
  EXPECT_THROW(ConvolveByInput({}, parameters, in, 3, 1, &scratch, &out), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom
