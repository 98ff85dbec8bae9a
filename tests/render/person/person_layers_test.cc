// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/person/person_layers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace bodyloom {
namespace {

TEST(FillAround, GivesEmptyPixelsTheWeightedMeanNearby) {
  const int width = 4, height = 2;
  std::vector<float> alpha(8, 0), colour(24, -1);
  alpha[0] = 1, alpha[1] = 0.5F;
  for (size_t c = 0; c < 3; ++c) colour[8 * c] = 0.3F, colour[8 * c + 1] = 0.9F;
  FillAround(width, height, alpha, colour);
  EXPECT_FLOAT_EQ(colour[0], 0.3F) << "what is seen stays";
  EXPECT_FLOAT_EQ(colour[1], 0.9F);
  for (const size_t i : {2U, 3U, 4U, 5U, 6U, 7U}) EXPECT_NEAR(colour[i], (0.3 + 0.45) / 1.5, 1e-6) << i;
}

TEST(FillAround, LeavesAnEmptyPictureAlone) {
  std::vector<float> alpha(6, 0), colour(18, 0.25F);
  FillAround(3, 2, alpha, colour);
  for (const float c : colour) EXPECT_EQ(c, 0.25F);
  EXPECT_THROW(FillAround(4, 2, alpha, colour), std::invalid_argument);
}

/// One pixel of a person in a box of 64×64 that begins left of and above the picture.
PersonLayers OnePixel() {
  PersonLayers layers;
  layers.x = -62, layers.y = -63, layers.width = layers.height = kLayersMultiple;
  layers.planes.assign(PersonPlane::kCount * layers.pixels(), 0);
  const size_t i = 63 * layers.pixels() / 64 + 63;  // pixel (1, 0) of the picture
  layers.planes[i] = 0.5F, layers.planes[layers.pixels() + i] = 0.25F, layers.planes[2 * layers.pixels() + i] = 1;
  layers.planes[3 * layers.pixels() + i] = 0.75F;
  return layers;
}

TEST(PersonLayers, NoChangeIsThePersonOverThePicture) {
  const PersonLayers layers = OnePixel();
  Image picture(3, 2, Colour{200, 100, 40});
  std::vector<uint8_t> coverage(6, 7);
  LayOver(layers, ChangedPerson(layers, std::vector<float>(4 * layers.pixels(), 0)), &picture, coverage);
  EXPECT_EQ(picture.pixel(1, 0)[2], std::lround(0.25 * picture.pixel(0, 0)[2] + 0.75 * 127.5));
  EXPECT_EQ(picture.pixel(1, 0)[1], std::lround(0.25 * picture.pixel(0, 0)[1] + 0.75 * 63.75));
  EXPECT_EQ(coverage[1], std::lround(0.75 * 255));
  EXPECT_EQ(coverage[0], 0) << "inside the box, nobody there";
  EXPECT_EQ(coverage[2], 7) << "outside the box";
  EXPECT_EQ(picture.pixel(2, 1)[0], picture.pixel(0, 0)[0]);
}

TEST(PersonLayers, ChangesAreBoundedAndClamped) {
  const PersonLayers layers = OnePixel();
  std::vector<float> change(4 * layers.pixels(), 0);
  const size_t i = 63 * layers.pixels() / 64 + 63;
  change[i] = 0.1F, change[layers.pixels() + i] = -100, change[3 * layers.pixels() + i] = 100;
  const std::vector<float> person = ChangedPerson(layers, change);
  EXPECT_FLOAT_EQ(person[i], 0.5F + std::tanh(0.1F));
  EXPECT_EQ(person[layers.pixels() + i], 0);
  EXPECT_EQ(person[3 * layers.pixels() + i], 1);
  change.pop_back();
  EXPECT_THROW(ChangedPerson(layers, change), std::invalid_argument);
}

/// A block of 24×20 pixels from (x0, y0) on in a box of 64×64.
PersonLayers Block(int x0, int y0) {
  PersonLayers layers;
  layers.width = layers.height = kLayersMultiple;
  layers.planes.assign(4 * layers.pixels(), 0);
  for (int y = y0; y < y0 + 20; ++y) {
    for (int x = x0; x < x0 + 24; ++x) layers.planes[3 * layers.pixels() + static_cast<size_t>(y) * 64 + x] = 1;
  }
  return layers;
}

TEST(PersonLayers, OutlinesMoveNoFurtherThanAllowed) {
  const PersonLayers layers = Block(20, 30);
  for (const float sign : {1.0F, -1.0F}) {
    std::vector<float> change(4 * layers.pixels(), sign);
    KeepNearOutline(layers, change);
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 64; ++x) {
        const size_t i = static_cast<size_t>(y) * 64 + x;
        ASSERT_EQ(change[i], sign) << "colours change everywhere";
        const int outside = std::max({20 - x, x - 43, 30 - y, y - 49}), inside = 1 - outside;  // pixels from the block
        const bool allowed = sign > 0 ? outside <= OutlineReach::kOutwards : inside <= OutlineReach::kInwards;
        ASSERT_EQ(change[3 * layers.pixels() + i], allowed ? sign : 0) << x << " " << y;
      }
    }
  }
  std::vector<float> change(7);
  EXPECT_THROW(KeepNearOutline(layers, change), std::invalid_argument);
}

TEST(PersonLayers, AnEnlargedChangeIsLinearBetweenPixelCentres) {
  PersonLayers small, large;
  small.x = 3, small.y = -2, small.width = small.height = 64;
  large.x = 40, large.y = 10, large.width = 64, large.height = 128;
  const auto ramp = [](double x, double y) { return 0.02 * x - 0.01 * y + 0.3; };
  std::vector<float> change(4 * small.pixels());
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      for (size_t c = 0; c < 4; ++c) {
        change[c * small.pixels() + static_cast<size_t>(y) * 64 + x] =
            static_cast<float>(ramp(small.x + x, small.y + y) * static_cast<double>(c + 1));
      }
    }
  }
  const double factor = 0.4;
  const std::vector<float> enlarged = EnlargedChange(small, change, factor, large);
  int inside = 0;
  for (int y = 0; y < large.height; ++y) {
    for (int x = 0; x < large.width; ++x) {
      const double u = factor * (large.x + x + 0.5) - 0.5, v = factor * (large.y + y + 0.5) - 0.5;
      if (u < small.x || v < small.y || u > small.x + 63 || v > small.y + 63) continue;
      ++inside;
      for (size_t c = 0; c < 4; ++c) {
        const size_t i = c * large.pixels() + static_cast<size_t>(y) * large.width + x;
        ASSERT_NEAR(enlarged[i], ramp(u, v) * static_cast<double>(c + 1), 1e-5) << x << " " << y;
      }
    }
  }
  EXPECT_GT(inside, 4000);
  large.x = 400;
  for (const float value : EnlargedChange(small, change, factor, large)) ASSERT_EQ(value, 0) << "outside the small box";
  small.x = large.x = 5, small.y = large.y = 7, large.height = 64;
  EXPECT_EQ(EnlargedChange(small, change, 1, large), change);
  EXPECT_THROW(EnlargedChange(small, change, 0, large), std::invalid_argument);
  change.pop_back();
  EXPECT_THROW(EnlargedChange(small, change, 1, large), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom
