// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/still_background.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/tracking/detection/masked_clip.h"

namespace bodyloom::still_background_test {
namespace {

std::vector<CoveredImage> Covered(const MaskedClip& clip) {
  std::vector<CoveredImage> images;
  for (size_t t = 0; t < clip.images.size(); ++t) images.push_back({clip.images[t], clip.masks[t]});
  return images;
}

TEST(StillBackground, IsWhatNobodyCovers) {
  const MaskedClip clip(20);
  const auto background = FindStillBackground(Covered(clip));
  ASSERT_TRUE(background.has_value());
  for (size_t i = 0; i < background->sigma.size(); ++i) {
    ASSERT_GT(background->sigma[i], 2.9F) << i;  // everybody walks on
    for (size_t c = 0; c < 3; ++c) {
      ASSERT_NEAR(background->colours.bgr[3 * i + c], clip.wall.bgr[3 * i + c], 2) << i;
    }
  }
}

TEST(StillBackground, DoesNotKnowWhatIsAlwaysCovered) {
  const MaskedClip clip(12);
  std::vector<CoveredImage> images = Covered(clip);
  for (size_t t = 0; t < images.size(); ++t) {
    images[t].covered[7] = 1;
    images[t].covered[9] = t < 8 ? 1 : 0;  // four pictures show it
  }
  const auto background = FindStillBackground(images);
  ASSERT_TRUE(background.has_value());
  EXPECT_EQ(background->sigma[7], 0);
  EXPECT_EQ(background->sigma[9], 0);
  EXPECT_EQ(background->colours.at(7, 0), Colour{});
  EXPECT_TRUE(FindStillBackground(images, {.fewest = 4})->sigma[9] > 0);
}

TEST(StillBackground, EdgesAndWhatFlickersAreLessSure) {
  MaskedClip clip(15);
  for (size_t t = 0; t < clip.images.size(); ++t) {
    for (int x = 0; x < MaskedClip::kWidth; ++x) {
      for (int c = 0; c < 3; ++c) clip.images[t].pixel(x, 3)[c] = static_cast<uint8_t>(90 + 10 * (t % 3));
      for (int c = 0; c < 3; ++c) clip.images[t].pixel(x, 8)[c] = x < 80 ? 40 : 220;
    }
  }
  const auto background = FindStillBackground(Covered(clip));
  ASSERT_TRUE(background.has_value());
  const auto sigma = [&](int x, int y) { return background->sigma[size_t(y) * MaskedClip::kWidth + x]; };
  EXPECT_NEAR(sigma(50, 3), std::hypot(14.8, 3), 0.2);
  EXPECT_GT(sigma(80, 8), 25) << "a third of a step of 90 a pixel";
}

TEST(StillBackground, IsNoneOfACameraThatMovesOrOfTooFewImages) {
  EXPECT_FALSE(FindStillBackground(Covered(MaskedClip(20, 2))).has_value());
  EXPECT_FALSE(FindStillBackground(Covered(MaskedClip(4))).has_value());
  EXPECT_FALSE(FindStillBackground({}).has_value());
  std::vector<CoveredImage> hidden = Covered(MaskedClip(20));
  for (CoveredImage& seen : hidden) std::fill(seen.covered.begin(), seen.covered.begin() + 11000, uint8_t{1});
  EXPECT_FALSE(FindStillBackground(hidden).has_value()) << "more than half is never seen";
}

TEST(StillBackground, IsTheSameForAnyThreads) {
  const std::vector<CoveredImage> images = Covered(MaskedClip(13));
  const auto one = FindStillBackground(images);
  for (const int threads : {2, 5}) {
    const auto other = FindStillBackground(images, {.num_threads = threads});
    EXPECT_EQ(one->colours, other->colours);
    EXPECT_EQ(one->sigma, other->sigma);
  }
}

TEST(StillBackground, RefusesImagesThatDoNotFit) {
  std::vector<CoveredImage> images = Covered(MaskedClip(6));
  images[3].covered.pop_back();
  EXPECT_THROW(FindStillBackground(images), std::invalid_argument);
  images = Covered(MaskedClip(6));
  images[5].image = Image(8, 8);
  EXPECT_THROW(FindStillBackground(images), std::invalid_argument);
  EXPECT_THROW(FindStillBackground(images, {.fewest = 0}), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::still_background_test
