// SPDX-License-Identifier: Apache-2.0
// Images of a lens that distorts, drawn by their formula, against what an ideal camera sees.
#include "render/image/lens_correction.h"

#include <gtest/gtest.h>

#include <cmath>

namespace bodyloom::lens_correction_test {
namespace {

constexpr int kWidth = 320, kHeight = 240;

/// Grey value seen along a ray: smooth, and different everywhere.
uint8_t GreyOf(double a, double b) { return uint8_t(std::lround(128 + 60 * std::sin(5 * a + 1) * std::cos(4 * b))); }

Camera Lens(bool distorts) {
  Camera camera = MakePinhole(kWidth, kHeight, 300);
  camera.cx = 165, camera.cy = 118;
  if (distorts) camera.distortion = {-0.25, 0.06, 0.001, -0.002};
  return camera;
}

Image Seen(const Camera& camera) {
  Image image(camera.width, camera.height);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector2d ray = camera.Unproject({x, y});
      image.pixel(x, y)[0] = image.pixel(x, y)[1] = image.pixel(x, y)[2] = GreyOf(ray.x(), ray.y());
    }
  }
  return image;
}

TEST(LensCorrection, ImagesAreThoseOfAnIdealCamera) {
  const LensCorrection correction(Lens(true));
  EXPECT_FALSE(correction.ideal().HasDistortion());
  EXPECT_EQ(correction.ideal().cx, 165);
  const Image corrected = correction.Corrected(Seen(Lens(true))), expected = Seen(Lens(false));
  int compared = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto source = correction.SourceOf(x, y);
      if (!source || source->x < 1 || source->y < 1 || source->x > kWidth - 2 || source->y > kHeight - 2) continue;
      EXPECT_NEAR(corrected.pixel(x, y)[1], expected.pixel(x, y)[1], 2) << x << ", " << y;
      const Eigen::Vector2d ray = Lens(true).Unproject({source->x, source->y});
      EXPECT_NEAR(300 * ray.x() + 165, x, 1.2) << "the nearest pixel of the lens' image";
      ++compared;
    }
  }
  EXPECT_GT(compared, kWidth * kHeight * 8 / 10);
}

TEST(LensCorrection, WithoutDistortionNothingChanges) {
  const LensCorrection correction(Lens(false));
  const Image image = Seen(Lens(false));
  EXPECT_EQ(correction.Corrected(image), image);
  const auto source = correction.SourceOf(17, 230);
  ASSERT_TRUE(source);
  EXPECT_EQ(source->x, 17);
  EXPECT_EQ(source->y, 230);
  EXPECT_FALSE(correction.SourceOf(-1, 0));
  EXPECT_FALSE(correction.SourceOf(0, kHeight));
}

TEST(LensCorrection, WrongInputs) {
  EXPECT_THROW(LensCorrection(Lens(true)).Corrected(Image(10, 10)), std::invalid_argument);
  Camera weak = Lens(false);
  weak.model = CameraModel::kWeakPerspective;
  EXPECT_THROW(LensCorrection{weak}, std::invalid_argument);
  EXPECT_THROW(LensCorrection{Camera()}, std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::lens_correction_test
