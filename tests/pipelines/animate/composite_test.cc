// SPDX-License-Identifier: Apache-2.0
// Compositing of a rendered person over a background, at the networks' size and enlarged.
#include "pipelines/animate/background.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace bodyloom::composite_test {
namespace {

PersonWindow WindowAt(int width, int height, const Eigen::Vector2i& corner, int image_width, int image_height) {
  PersonWindow window;
  window.width = width, window.height = height;
  window.image_width = image_width, window.image_height = image_height;
  window.corner = {corner};
  return window;
}

/// A person of random colours and coverage: planar RGB, multiplied by alpha.
struct Person {
  std::vector<float> image, alpha;
  Person(int width, int height) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(0, 1);
    const size_t area = static_cast<size_t>(width) * height;
    alpha.resize(area);
    image.resize(3 * area);
    for (float& a : alpha) a = uniform(random);
    for (size_t i = 0; i < image.size(); ++i) image[i] = uniform(random) * alpha[i % area];
  }
};

TEST(Composite, AtTheNetworksSizeEveryPixelIsImagePlusWhatAlphaLeavesOfTheImage) {
  const Person person(5, 4);
  for (const auto& corner :
       {Eigen::Vector2i(2, 3), Eigen::Vector2i(-2, -1), Eigen::Vector2i(9, 6), Eigen::Vector2i(50, 50)}) {
    Image image(12, 9, {10, 90, 200});
    Composite(person.image, person.alpha, WindowAt(5, 4, corner, 12, 9), 0, &image);
    for (int y = 0; y < 9; ++y) {
      for (int x = 0; x < 12; ++x) {
        const int u = x - corner.x(), v = y - corner.y();
        const bool inside = u >= 0 && u < 5 && v >= 0 && v < 4;
        const float a = inside ? person.alpha[v * 5 + u] : 0;
        const auto expected = [&](int c, float behind) {
          return std::lround((inside ? 255 * person.image[20 * c + v * 5 + u] : 0) + (1 - a) * behind);
        };
        const Colour colour = image.at(x, y);
        ASSERT_EQ(colour.red, expected(0, 10)) << x << ", " << y;
        ASSERT_EQ(colour.green, expected(1, 90)) << x << ", " << y;
        ASSERT_EQ(colour.blue, expected(2, 200)) << x << ", " << y;
      }
    }
  }
}

/// Bilinear interpolation keeps a ramp: three times as large, its values lie on the same line.
TEST(Composite, EnlargedARampStaysOneAndLiesWhereItLay) {
  constexpr int kSide = 8, kTimes = 3;
  std::vector<float> alpha(kSide * kSide, 1), image;
  for (int c = 0; c < 3; ++c) {
    for (int i = 0; i < kSide * kSide; ++i) image.push_back(static_cast<float>(i % kSide + 4) / 16);
  }
  Image canvas(10 * kTimes, 10 * kTimes, {0, 255, 0});
  Composite(image, alpha, WindowAt(kSide, kSide, {1, 1}, 10, 10), 0, &canvas);
  for (int y = kTimes * 2; y < kTimes * 8; ++y) {
    for (int x = kTimes * 2; x < kTimes * 8; ++x) {
      const double column = (x + 0.5) / kTimes - 0.5 - 1;
      ASSERT_NEAR(canvas.at(x, y).red, 255 * (column + 4) / 16, 0.51) << x << ", " << y;
    }
  }
  EXPECT_EQ(canvas.at(0, 0), (Colour{0, 255, 0}));
  EXPECT_EQ(canvas.at(29, 15), (Colour{0, 255, 0}));
}

TEST(Composite, ImagesAreAsLargeAsTheNetworksDrawOrAsTheCamera) {
  const PersonWindow window = WindowAt(64, 96, {0, 0}, 108, 72);
  const Camera camera = MakePinhole(1920, 1280, 1500);
  const ImageSize small = SizeOfImages(window, camera, false), large = SizeOfImages(window, camera, true);
  EXPECT_EQ(small.width, 108);
  EXPECT_EQ(small.height, 72);
  EXPECT_EQ(large.width, 1920);
  EXPECT_EQ(large.height, 1280);
}

TEST(Background, AnotherShapeIsCutAndNotStretched) {
  Image wide(40, 10, {1, 1, 1});
  for (int y = 0; y < 10; ++y) {
    for (int x = 15; x < 25; ++x) wide.pixel(x, y)[2] = 201;  // a red square in the middle
  }
  const Image square = Covering(wide, 10, 10), larger = Covering(wide, 20, 20);
  EXPECT_EQ(square, Image(10, 10, {201, 1, 1}));
  EXPECT_EQ(larger.width, 20);
  EXPECT_EQ(larger.at(10, 10), (Colour{201, 1, 1}));
  EXPECT_EQ(Covering(wide, 40, 10), wide);
  const Image tall = Covering(wide, 10, 40);
  EXPECT_EQ(tall.height, 40);
  EXPECT_EQ(tall.at(5, 20), (Colour{201, 1, 1}));
}

}  // namespace
}  // namespace bodyloom::composite_test
