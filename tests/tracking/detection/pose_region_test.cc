// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/pose_region.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace bodyloom::pose_region_test {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(PoseRegion, AnUprightBodyIsNotTurned) {
  const PoseRegion region = RegionAroundBody({100, 200}, {100, 120});
  EXPECT_TRUE(region.centre.isApprox(Eigen::Vector2d(100, 200)));
  EXPECT_DOUBLE_EQ(region.side, 200);
  EXPECT_NEAR(region.rotation, 0, 1e-15);
}

TEST(PoseRegion, TheBodysAxisIsUpInTheCropWhateverItsDirection) {
  for (int degrees = -180; degrees < 180; degrees += 7) {
    const double angle = degrees * kPi / 180;
    const Eigen::Vector2d hips(310.5, 77.25), rim = hips + 64 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    const PoseRegion region = RegionAroundBody(hips, rim);
    EXPECT_GE(region.rotation, -kPi);
    EXPECT_LT(region.rotation, kPi);
    // The rim lies 1 / 2.5 of the side above the middle.
    EXPECT_TRUE(region.FractionFromImage(rim).isApprox(Eigen::Vector2d(0.5, 0.1), 1e-12)) << degrees;
  }
}

TEST(PoseRegion, FractionsAndPixelsAreInverse) {
  const PoseRegion region{.centre = {12.5, -7}, .side = 91.5, .rotation = 2.1};
  for (const Eigen::Vector2d& f : {Eigen::Vector2d(0, 0), Eigen::Vector2d(0.3, 0.9), Eigen::Vector2d(1.5, -2)}) {
    EXPECT_TRUE(region.FractionFromImage(region.ImageFromFraction(f)).isApprox(f, 1e-12) ||
                region.FractionFromImage(region.ImageFromFraction(f)).norm() < 1e-12);
  }
  EXPECT_TRUE(region.ImageFromFraction({0.5, 0.5}).isApprox(region.centre));
}

TEST(PoseRegion, WhatIsNotFiniteOrHasNoExtentIsNotValid) {
  EXPECT_FALSE(PoseRegion().IsValid());
  EXPECT_FALSE((PoseRegion{.centre = {NAN, 0}, .side = 10}).IsValid());
  EXPECT_FALSE((PoseRegion{.centre = {0, 0}, .side = INFINITY}).IsValid());
  EXPECT_FALSE((PoseRegion{.centre = {0, 0}, .side = 10, .rotation = NAN}).IsValid());
  EXPECT_TRUE((PoseRegion{.centre = {0, 0}, .side = 10}).IsValid());
  EXPECT_FALSE(RegionAroundBody({5, 5}, {5, 5}).IsValid());
}

bool Holds(const PoseRegion& square, double x, double y) {
  const Eigen::Vector2d f = square.FractionFromImage({x, y});
  return f.minCoeff() >= -1e-9 && f.maxCoeff() <= 1 + 1e-9;
}

TEST(PoseRegion, TilesCoverTheImageAndOverlapByHalf) {
  for (const auto& [width, height] :
       {std::pair(1920, 1080), std::pair(576, 1024), std::pair(500, 500), std::pair(90, 1000)}) {
    for (int level = 1; level <= 4; ++level) {
      const std::vector<PoseRegion> tiles = TileRegions(width, height, level);
      const double side = double(std::max(width, height)) / level;
      for (const PoseRegion& tile : tiles) EXPECT_DOUBLE_EQ(tile.side, side);
      // Whoever is half as tall as a square lies wholly in one, wherever he stands.
      const double step = side / 7, half = side / 4;
      for (double y = half; y <= height - half; y += step) {
        for (double x = half; x <= width - half; x += step) {
          const bool held = std::any_of(tiles.begin(), tiles.end(), [&](const PoseRegion& tile) {
            return Holds(tile, x - half, y - half) && Holds(tile, x + half, y + half);
          });
          EXPECT_TRUE(held) << width << "x" << height << " level " << level << " at " << x << ", " << y;
        }
      }
    }
  }
  EXPECT_THAT(TileRegions(100, 100, 0), ::testing::IsEmpty());
  EXPECT_THAT(TileRegions(1000, 1000, 2), ::testing::SizeIs(9));
}

/// A picture whose colours are linear in place: bilinear sampling is exact then.
Image Ramp(int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.pixel(x, y)[0] = uint8_t(2 * x);
      image.pixel(x, y)[1] = uint8_t(3 * y);
      image.pixel(x, y)[2] = uint8_t(x + y);
    }
  }
  return image;
}

TEST(PoseRegion, CropsSampleTheImageWhereTheFormulaSays) {
  const Image image = Ramp(100, 80);
  const PoseRegion region{.centre = {50, 40}, .side = 32, .rotation = 0.4};
  const int size = 16;
  const std::vector<float> crop = CropRegion(image, region, size, 1, 0);
  ASSERT_EQ(crop.size(), size_t(size) * size * 3);
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      const Eigen::Vector2d at = region.ImageFromFraction(Eigen::Vector2d(column, row) / size);
      const float* rgb = &crop[(size_t(row) * size + column) * 3];
      // Half a grey level of rounding, and places on a grid of 1/32 pixel.
      EXPECT_NEAR(rgb[0], at.x() + at.y(), 0.6);
      EXPECT_NEAR(rgb[1], 3 * at.y(), 0.6);
      EXPECT_NEAR(rgb[2], 2 * at.x(), 0.6);
    }
  }
}

TEST(PoseRegion, OutsideTheImageIsBlackBeforeScaling) {
  const Image image(20, 20, {255, 255, 255});
  const std::vector<float> crop = CropRegion(image, {.centre = {0, 10}, .side = 20}, 10, 2.0F / 255, -1);
  EXPECT_FLOAT_EQ(crop[0], -1);
  EXPECT_FLOAT_EQ(crop[9 * 3], 1);
  EXPECT_THROW(CropRegion(Image(), WholeImageRegion(4, 4), 4, 1, 0), std::invalid_argument);
  EXPECT_THROW(CropRegion(image, PoseRegion(), 4, 1, 0), std::invalid_argument);
  EXPECT_THROW(CropRegion(image, WholeImageRegion(4, 4), 0, 1, 0), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::pose_region_test
