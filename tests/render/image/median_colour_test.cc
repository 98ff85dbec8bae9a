// SPDX-License-Identifier: Apache-2.0
#include "render/image/palette.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>
#include <stdexcept>
#include <vector>

#include "geometry/base/percentile.h"

namespace bodyloom::median_colour_test {
namespace {

TEST(MedianColour, IsTheMiddleOfEachChannel) {
  const std::vector<ChannelTriple> colours = {{1, 30, 7}, {3, 10, 7}, {2, 20, 900}};
  EXPECT_EQ(MedianColour(colours), (ChannelTriple{2, 20, 7}));
  EXPECT_EQ(MedianColour(std::vector<ChannelTriple>{{4, 5, 6}}), (ChannelTriple{4, 5, 6}));
}

TEST(MedianColour, OfAnEvenNumberIsTheMeanOfTheMiddleTwo) {
  const std::vector<ChannelTriple> colours = {{8, 0, 1}, {2, 0, 1}, {4, 1, 1}, {0, 1, 1}};
  EXPECT_EQ(MedianColour(colours), (ChannelTriple{3, 0.5F, 1}));
}

TEST(MedianColour, IsThePercentileOfSortedChannels) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> value(-5, 5);
  for (const size_t count : {2U, 5U, 64U, 101U}) {
    std::vector<ChannelTriple> colours(count);
    for (ChannelTriple& colour : colours) {
      for (float& channel : colour) channel = value(random);
    }
    const ChannelTriple median = MedianColour(colours);
    for (size_t c = 0; c < 3; ++c) {
      std::vector<double> channel(count);
      std::transform(colours.begin(), colours.end(), channel.begin(), [c](const ChannelTriple& v) { return v[c]; });
      EXPECT_NEAR(median[c], Percentile(channel, 50), 1e-6) << count << " colours, channel " << c;
    }
  }
}

TEST(MedianColour, OfFewIsNone) {
  const std::vector<ChannelTriple> colours = {{1, 30, 7}, {3, 10, 7}, {2, 20, 900}};
  EXPECT_EQ(MedianColourOfMany(colours, 3), MedianColour(colours));
  EXPECT_EQ(MedianColourOfMany(colours, 4), std::nullopt);
}

TEST(MedianColour, OfNoColourIsRefused) { EXPECT_THROW(MedianColour({}), std::invalid_argument); }

}  // namespace
}  // namespace bodyloom::median_colour_test
