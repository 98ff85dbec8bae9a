// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/avatar/motion/motion_network.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>

#include "tests/render/splat/same_bytes.h"

namespace bodyloom {
namespace {

/// A map of doubles, channels × side × side, and the layers of the header's formula written out one texel at a time.
struct Plane {
  int channels = 0, side = 0;
  std::vector<double> values;
  Plane(int c, int s) : channels(c), side(s), values(size_t(c) * s * s, 0) {}
  double& at(int c, int y, int x) { return values[(size_t(c) * side + y) * side + x]; }
  [[nodiscard]] double Or0(int c, int y, int x) const {
    return y < 0 || x < 0 || y >= side || x >= side ? 0 : values[(size_t(c) * side + y) * side + x];
  }
};

class Twin {
 public:
  Twin(const MotionNetworkOptions& options, const std::vector<uint8_t>& shows_body, std::vector<double> parameters)
      : o_(options), shows_(shows_body), p_(std::move(parameters)) {}

  Plane Out(const std::vector<float>& maps) {
    next_ = 0;
    const int channels = (o_.maps + 1 + o_.embedding + 15) / 16 * 16, texels = o_.side * o_.side, width = o_.width;
    Plane in(channels, o_.side);
    const size_t embedding = p_.size() - size_t(o_.embedding) * texels;
    for (int t = 0; t < texels; ++t) {
      for (int k = 0; k < o_.maps; ++k) in.at(k, t / o_.side, t % o_.side) = maps[size_t(k) * texels + t];
      in.at(o_.maps, t / o_.side, t % o_.side) = shows_[t] != 0;
      for (int k = 0; k < o_.embedding; ++k) {
        in.at(o_.maps + 1 + k, t / o_.side, t % o_.side) = p_[embedding + size_t(t) * o_.embedding + k];
      }
    }
    const Plane a = Layer(in, width, 3, 2, true), b = Layer(a, width, 3, 1, true), c = Layer(b, width, 3, 2, true),
                d = Layer(c, width, 3, 1, true), e = Layer(d, width, 3, 2, true);
    Plane f = Layer(e, width, 3, 1, true);
    const size_t dense = embedding - size_t(width) * width - width;
    std::vector<double> g(width);
    for (int k = 0; k < width; ++k) {
      g[k] = p_[dense + size_t(width) * width + k];
      for (int n = 0; n < width; ++n) {
        double mean = 0;
        for (int i = 0; i < f.side * f.side; ++i) mean += f.values[size_t(n) * f.side * f.side + i];
        g[k] += mean / (f.side * f.side) * p_[dense + size_t(n) * width + k];
      }
    }
    for (int k = 0; k < width; ++k) {
      for (int i = 0; i < f.side * f.side; ++i) f.values[size_t(k) * f.side * f.side + i] += std::max(0.0, g[k]);
    }
    const Plane h = Layer(Up(f, &d), width, 3, 1, true), i = Layer(Up(h, &b), width, 3, 1, true),
                j = Layer(Up(i, nullptr), 16, 3, 1, true);
    return Layer(j, (o_.outputs + 15) / 16 * 16, 1, 1, false);
  }

 private:
  Plane Layer(const Plane& in, int channels, int size, int stride, bool rectify) {
    Plane out(channels, in.side / stride);
    const size_t weights = next_, bias = weights + size_t(size) * size * in.channels * channels;
    for (int c = 0; c < channels; ++c) {
      for (int y = 0; y < out.side; ++y) {
        for (int x = 0; x < out.side; ++x) {
          double sum = p_[bias + c];
          for (int i = 0; i < size; ++i) {
            for (int j = 0; j < size; ++j) {
              for (int k = 0; k < in.channels; ++k) {
                sum += in.Or0(k, stride * y + i - size / 2, stride * x + j - size / 2) *
                       p_[weights + ((size_t(i) * size + j) * in.channels + k) * channels + c];
              }
            }
          }
          out.at(c, y, x) = rectify ? std::max(0.0, sum) : sum;
        }
      }
    }
    next_ = bias + channels;
    return out;
  }
  static Plane Up(const Plane& coarse, const Plane* skip) {
    Plane up(coarse.channels, 2 * coarse.side);
    for (int c = 0; c < up.channels; ++c) {
      for (int y = 0; y < up.side; ++y) {
        for (int x = 0; x < up.side; ++x) {
          up.at(c, y, x) = coarse.Or0(c, y / 2, x / 2) + (skip != nullptr ? skip->Or0(c, y, x) : 0);
        }
      }
    }
    return up;
  }

  MotionNetworkOptions o_;
  std::vector<uint8_t> shows_;
  std::vector<double> p_;
  size_t next_ = 0;
};

struct Case {
  MotionNetworkOptions options{.side = 64, .maps = 5, .embedding = 3, .width = 16, .outputs = 20};
  std::vector<uint8_t> shows_body;
  std::vector<float> maps;
  FloatColumns parameters;

  Case() {
    std::mt19937 numbers(7);
    const auto uniform = [&] { return static_cast<float>(numbers() / 2147483648.0 - 1); };
    for (int t = 0; t < 64 * 64; ++t) shows_body.push_back(t % 3 != 0);
    for (int i = 0; i < 5 * 64 * 64; ++i) maps.push_back(uniform());
    parameters = MotionNetwork(options, shows_body).Initial(3);
    // The last layer and the biases begin as zero: not here.
    for (float& p : parameters.values(0)) p += 0.05F * uniform();
  }
  [[nodiscard]] std::vector<double> Doubles() const {
    return {parameters.values(0).begin(), parameters.values(0).end()};
  }
};

TEST(MotionNetwork, IsTheFormula) {
  const Case c;
  MotionNetwork network(c.options, c.shows_body);
  const TexelFeatures& out = network.Forward(c.parameters, c.maps, 2);
  Plane truth = Twin(c.options, c.shows_body, c.Doubles()).Out(c.maps);
  double largest = 0;
  for (int k = 0; k < 20; ++k) {
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 64; ++x) {
        largest = std::max(largest, std::abs(truth.at(k, y, x)));
        ASSERT_NEAR(out.at(y, x)[k], truth.at(k, y, x), 1e-4) << k << " " << y << " " << x;
      }
    }
  }
  EXPECT_GT(largest, 0.1);
}

// Against central differences of the twin in double precision, along random directions within each kind of parameter.
TEST(MotionNetwork, DerivativesAreThoseOfTheFormula) {
  const Case c;
  MotionNetwork network(c.options, c.shows_body);
  const TexelFeatures& out = network.Forward(c.parameters, c.maps, 1);
  std::mt19937 numbers(8);
  const auto uniform = [&] { return static_cast<float>(numbers() / 2147483648.0 - 1); };
  TexelFeatures by_out(64, out.channels());
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      for (int k = 0; k < 20; ++k) by_out.at(y, x)[k] = uniform();
    }
  }
  FloatColumns by_parameters;
  network.Backward(c.parameters, by_out, 2, &by_parameters);
  ASSERT_EQ(by_parameters.rows(), network.num_parameters());
  const auto loss = [&](const std::vector<double>& parameters) {
    Plane twin = Twin(c.options, c.shows_body, parameters).Out(c.maps);
    double sum = 0;
    for (int k = 0; k < 20; ++k) {
      for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) sum += double(by_out.at(y, x)[k]) * twin.at(k, y, x);
      }
    }
    return sum;
  };
  const std::vector<double> at = c.Doubles();
  const int total = network.num_parameters(), embedding = total - 3 * 64 * 64, parts = 12;
  for (int part = 0; part <= parts; ++part) {
    const int first = part == parts ? embedding : int(int64_t{embedding} * part / parts);
    const int last = part == parts ? total : int(int64_t{embedding} * (part + 1) / parts);
    std::vector<double> above = at, below = at;
    double predicted = 0;
    constexpr double kStep = 1e-6;
    for (int i = first; i < last; ++i) {
      const double direction = uniform();
      above[i] += kStep * direction, below[i] -= kStep * direction;
      predicted += direction * by_parameters(i, 0);
    }
    const double difference = (loss(above) - loss(below)) / (2 * kStep);
    EXPECT_GT(std::abs(difference), 1e-3) << part;
    EXPECT_NEAR(predicted, difference, 2e-3 * std::abs(difference) + 2e-3) << part;
  }
}

TEST(MotionNetwork, ANewOneChangesNothing) {
  const Case c;
  MotionNetwork network(c.options, c.shows_body);
  const TexelFeatures& out = network.Forward(network.Initial(1), c.maps, 1);
  for (int y = 0; y < 64; ++y) {
    for (int i = 0; i < 64 * out.channels(); ++i) ASSERT_EQ(out.at(y, 0)[i], 0);
  }
}

TEST(MotionNetwork, SameBytesForAnyThreadsAndInstructionSet) {
  const Case c;
  ExpectSameBytesEverywhere([&](int threads, FloatColumns* table) {
    MotionNetwork network(c.options, c.shows_body);
    TexelFeatures by_out(64, 32);
    const TexelFeatures& out = network.Forward(c.parameters, c.maps, threads);
    for (int y = 0; y < 64; ++y) std::copy_n(out.at(y, 0), 64 * 32, by_out.at(y, 0));
    network.Backward(c.parameters, by_out, threads, table);
  });
}

TEST(MotionNetwork, RefusesWhatDoesNotFit) {
  const Case c;
  EXPECT_THROW(MotionNetwork({.side = 48}, std::vector<uint8_t>(48 * 48)), std::invalid_argument);
  EXPECT_THROW(MotionNetwork({.width = 20}, c.shows_body), std::invalid_argument);
  EXPECT_THROW(MotionNetwork({}, {}), std::invalid_argument);
  MotionNetwork network(c.options, c.shows_body);
  EXPECT_THROW(network.Forward(c.parameters, std::span(c.maps).first(9), 1), std::invalid_argument);
  EXPECT_THROW(network.Forward(FloatColumns(1, 7), c.maps, 1), std::invalid_argument);
  FloatColumns by;
  EXPECT_THROW(network.Backward(c.parameters, TexelFeatures(32, 32), 1, &by), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom
