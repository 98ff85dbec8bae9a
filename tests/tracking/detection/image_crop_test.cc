// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/image_crop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace bodyloom::image_crop_test {
namespace {

/// Red grows along x, green along y.
Image Ramp(int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.pixel(x, y)[2] = uint8_t(x);
      image.pixel(x, y)[1] = uint8_t(y);
      image.pixel(x, y)[0] = 7;
    }
  }
  return image;
}

TEST(LetterboxCrop, CentresTheWholeImage) {
  const ImageCrop wide = LetterboxCrop(1280, 720, 640, 640);
  EXPECT_DOUBLE_EQ(wide.gain.x(), 0.5);
  EXPECT_DOUBLE_EQ(wide.gain.y(), 0.5);
  EXPECT_DOUBLE_EQ(wide.shift.x(), 0);
  EXPECT_DOUBLE_EQ(wide.shift.y(), 140);
  // 231.75 rows become 232; an odd border is larger to the right and below.
  const ImageCrop tall = LetterboxCrop(103, 309, 640, 231);
  EXPECT_DOUBLE_EQ(tall.gain.x(), 231.0 / 309);
  EXPECT_DOUBLE_EQ(tall.shift.x(), 281);  // (640 − 77) / 2 = 281.5
  EXPECT_DOUBLE_EQ(tall.shift.y(), 0);
  const Eigen::Array2d corner = wide.ImageFromCrop({640, 500});
  EXPECT_DOUBLE_EQ(corner.x(), 1280);
  EXPECT_DOUBLE_EQ(corner.y(), 720);
  EXPECT_THROW(LetterboxCrop(0, 5, 640, 640), std::invalid_argument);
}

TEST(LetterboxPixels, PlanesOfRedGreenBlueWithGreyAround) {
  const Image image = Ramp(8, 4);
  const std::vector<float> pixels = LetterboxPixels(image, LetterboxCrop(8, 4, 8, 7));  // one row above, two below
  ASSERT_EQ(pixels.size(), 3U * 7 * 8);
  const auto at = [&pixels](size_t plane, size_t x, size_t y) { return 255 * pixels[(plane * 7 + y) * 8 + x]; };
  EXPECT_NEAR(at(0, 5, 1), 5, 1e-4);
  EXPECT_NEAR(at(1, 5, 1), 0, 1e-4);
  EXPECT_NEAR(at(1, 5, 4), 3, 1e-4);
  EXPECT_NEAR(at(2, 0, 2), 7, 1e-4);
  for (size_t plane = 0; plane < 3; ++plane) {
    EXPECT_NEAR(at(plane, 3, 0), 114, 1e-4);
    EXPECT_NEAR(at(plane, 3, 5), 114, 1e-4);
    EXPECT_NEAR(at(plane, 3, 6), 114, 1e-4);
  }
}

TEST(LetterboxPixels, ScalesBilinearly) {
  // Halved: pixel i lies over 2i and 2i + 1.
  const std::vector<float> pixels = LetterboxPixels(Ramp(16, 8), LetterboxCrop(16, 8, 8, 4));
  EXPECT_NEAR(255 * pixels[3], 6.5, 0.51);
  EXPECT_NEAR(255 * pixels[32 + 8 * 2], 4.5, 0.51);
}

TEST(TopDownCrop, GrowsTheBoxToTheProportions) {
  // 100 × 400 → 125 × 500 → 375 × 500 of 192 × 256.
  const ImageCrop tall = TopDownCrop({200, 100, 300, 500, 1}, 192, 256);
  EXPECT_NEAR(tall.gain.x(), 192 / 375.0, 1e-12);
  EXPECT_NEAR(tall.gain.y(), 256 / 500.0, 1e-12);
  const Eigen::Array2d low = tall.ImageFromCrop({0, 0}), middle = tall.ImageFromCrop({96, 128});
  EXPECT_NEAR(low.x(), 250 - 187.5, 1e-9);
  EXPECT_NEAR(low.y(), 300 - 250, 1e-9);
  EXPECT_NEAR(middle.x(), 250, 1e-9);
  EXPECT_NEAR(middle.y(), 300, 1e-9);
  // 400 × 100 → 500 × 125 → 500 × 666.7.
  const ImageCrop wide = TopDownCrop({0, 0, 400, 100, 1}, 192, 256);
  EXPECT_NEAR(wide.gain.x(), 192 / 500.0, 1e-12);
  EXPECT_NEAR(wide.gain.y(), 192 / 500.0, 1e-12);
  for (const PersonBox& box : {PersonBox{0, 0, 0, 5, 1}, PersonBox{0, 5, 5, 0, 1},
                               PersonBox{0, 0, std::numeric_limits<double>::quiet_NaN(), 5, 1}}) {
    EXPECT_THROW(TopDownCrop(box, 192, 256), std::invalid_argument);
  }
}

TEST(TopDownPixels, AreThoseOfTheBox) {
  const Image image = Ramp(200, 200);
  // 96 × 128 around (100, 90), after padding: gain 2.
  const ImageCrop crop = TopDownCrop({100 - 38.4, 90 - 51.2, 100 + 38.4, 90 + 51.2, 1}, 192, 256);
  ASSERT_NEAR(crop.gain.x(), 2, 1e-9);
  const std::vector<float> pixels = TopDownPixels(image, crop);
  const size_t plane = 192 * 256, row = 192;
  for (const auto& [x, y] : {std::pair<size_t, size_t>{96, 128}, {97, 129}, {10, 200}, {191, 0}}) {
    const Eigen::Array2d place = crop.ImageFromCrop({double(x), double(y)});
    EXPECT_NEAR(pixels[y * row + x] * 58.395 + 123.675, place.x(), 0.6);
    EXPECT_NEAR(pixels[plane + y * row + x] * 57.12 + 116.28, place.y(), 0.6);
    EXPECT_NEAR(pixels[2 * plane + y * row + x] * 57.375 + 103.53, 7, 1e-3);
  }
  // Outside the image is black.
  const std::vector<float> outside = TopDownPixels(image, TopDownCrop({-100, -100, -60, -50, 1}, 192, 256));
  EXPECT_NEAR(outside[0] * 58.395 + 123.675, 0, 1e-3);
}

}  // namespace
}  // namespace bodyloom::image_crop_test
