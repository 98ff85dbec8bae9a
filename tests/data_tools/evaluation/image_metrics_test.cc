// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/image_metrics.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace bodyloom::image_metrics_test {
namespace {

using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::NanSensitiveDoubleEq;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

PixelMask MaskOf(int width, int height, std::vector<uint8_t> inside) { return {width, height, std::move(inside)}; }

TEST(Psnr, ClosedForms) {
  const Image dark(4, 3, {100, 100, 100}), light(4, 3, {110, 110, 110});
  EXPECT_DOUBLE_EQ(Psnr(dark, light), 10 * std::log10(255.0 * 255 / 100));
  EXPECT_EQ(Psnr(dark, dark), std::numeric_limits<double>::infinity());
  EXPECT_DOUBLE_EQ(Psnr(Image(2, 2), Image(2, 2, {255, 255, 255})), 0);
  // One channel of one pixel off by 30 among twelve.
  Image spot = dark;
  spot.pixel(1, 2)[0] = 130;
  EXPECT_DOUBLE_EQ(Psnr(dark, spot), 10 * std::log10(255.0 * 255 / (900.0 / 36)));
  std::vector<uint8_t> inside(12);
  inside[2 * 4 + 1] = 255;
  inside[0] = 1;
  PixelMask mask = MaskOf(4, 3, inside);
  EXPECT_DOUBLE_EQ(Psnr(dark, spot, &mask), 10 * std::log10(255.0 * 255 / (900.0 / 6)));
  mask.inside.assign(12, 0);
  EXPECT_TRUE(std::isnan(Psnr(dark, spot, &mask)));
}

TEST(Psnr, PlanesAgreeWithBytesInAnyRange) {
  Image a(5, 4, {10, 200, 30}), b(5, 4, {12, 190, 33});
  a.pixel(3, 1)[1] = 7;
  PlanarImage plane_a = PlanarFrom(a), plane_b = PlanarFrom(b);
  EXPECT_EQ(plane_a.plane(0)[0], 10);  // red first
  EXPECT_NEAR(Psnr(plane_a, plane_b, 255), Psnr(a, b), 1e-12);
  for (double& value : plane_a.values) value /= 255;
  for (double& value : plane_b.values) value /= 255;
  EXPECT_NEAR(Psnr(plane_a, plane_b, 1), Psnr(a, b), 1e-12);
  plane_a.values[0] = kNaN;
  EXPECT_TRUE(std::isnan(Psnr(plane_a, plane_b, 1)));
  EXPECT_THROW(Psnr(plane_a, plane_b, 0), std::invalid_argument);
}

TEST(ImageMetrics, SizesMustAgree) {
  const Image a(4, 3), b(3, 4);
  const PixelMask mask = MaskOf(3, 4, std::vector<uint8_t>(12, 1));
  EXPECT_THROW(Psnr(a, b), std::invalid_argument);
  EXPECT_THROW(Psnr(a, a, &mask), std::invalid_argument);
  EXPECT_THROW(Psnr(PlanarFrom(a), {4, 3, 1, std::vector<double>(12)}, 255), std::invalid_argument);
  EXPECT_THROW(MaskIoU(mask, MaskFrom(a)), std::invalid_argument);
  EXPECT_THROW(CompareNormals(a, b), std::invalid_argument);
  EXPECT_THROW(CompareNormals(a, a, &mask), std::invalid_argument);
  EXPECT_THROW(CompareLabels(std::vector<uint8_t>(3), std::vector<uint8_t>(4), 7), std::invalid_argument);
}

TEST(ImageMetrics, MaskOverlap) {
  const PixelMask a = MaskOf(4, 1, {1, 1, 0, 0}), b = MaskOf(4, 1, {0, 200, 1, 0}), none = MaskOf(4, 1, {0, 0, 0, 0});
  EXPECT_DOUBLE_EQ(MaskIoU(a, b), 1.0 / 3);
  EXPECT_EQ(MaskIoU(a, a), 1);
  EXPECT_EQ(MaskIoU(a, none), 0);
  EXPECT_TRUE(std::isnan(MaskIoU(none, none)));
  Image image(2, 1, {127, 127, 127});
  image.pixel(1, 0)[2] = 128;
  EXPECT_THAT(MaskFrom(image).inside, ElementsAre(0, 1));
}

TEST(ImageMetrics, LabelOverlap) {
  const std::vector<uint8_t> truth = {0, 0, 1, 1, 2, 2}, result = {0, 1, 1, 1, 0, 4};
  const LabelOverlap overlap = CompareLabels(truth, result, 6);
  EXPECT_THAT(overlap.iou, ElementsAre(DoubleEq(1.0 / 3), DoubleEq(2.0 / 3), 0, NanSensitiveDoubleEq(kNaN), 0,
                                       NanSensitiveDoubleEq(kNaN)));
  EXPECT_DOUBLE_EQ(overlap.mean_iou, 0.25);  // of labels 0, 1, 2, 4
  EXPECT_DOUBLE_EQ(overlap.accuracy, 0.5);
  EXPECT_EQ(CompareLabels(truth, truth, 3).mean_iou, 1);
  EXPECT_TRUE(std::isnan(CompareLabels({}, {}, 3).mean_iou));
  EXPECT_THROW(CompareLabels(truth, result, 4), std::invalid_argument);
}

TEST(ImageMetrics, NormalAngles) {
  const auto of = [](const std::vector<Colour>& colours) {
    Image image(static_cast<int>(colours.size()), 1);
    for (size_t i = 0; i < colours.size(); ++i) {
      uint8_t* bgr = image.pixel(static_cast<int>(i), 0);
      bgr[0] = colours[i].blue, bgr[1] = colours[i].green, bgr[2] = colours[i].red;
    }
    return image;
  };
  // Bytes hold no zero: 127 is −1/255, 128 is 1/255. Along x, y, −z, then black and grey backgrounds.
  const Colour x{255, 128, 128}, y{128, 255, 128}, back{128, 128, 0}, black{0, 0, 0}, grey{128, 128, 128};
  const double small = 1.0 / 255, length = std::sqrt(1 + 2 * small * small);
  const auto angle = [&](double dot) { return std::acos(dot / (length * length)) * 180 / M_PI; };
  const double x_to_y = angle(2 * small + small * small), x_to_back = angle(small - small + small * small);
  const NormalError error = CompareNormals(of({x, x, x, black, grey}), of({x, y, back, x, x}));
  EXPECT_NEAR(error.mean_deg, (0 + x_to_y + x_to_back) / 3, 1e-9);
  EXPECT_NEAR(error.median_deg, std::min(x_to_y, x_to_back), 1e-9);
  EXPECT_EQ(error.coverage, 1);
  const NormalError half = CompareNormals(of({x, x, x, x}), of({x, y, black, grey}));
  EXPECT_NEAR(half.median_deg, x_to_y / 2, 1e-9);
  EXPECT_EQ(half.coverage, 0.5);
  const PixelMask first = MaskOf(4, 1, {1, 0, 0, 0});
  EXPECT_EQ(CompareNormals(of({x, x, x, x}), of({x, y, black, grey}), &first).mean_deg, 0);
  const NormalError none = CompareNormals(of({black, grey}), of({x, x}));
  EXPECT_TRUE(std::isnan(none.mean_deg) && std::isnan(none.median_deg) && std::isnan(none.coverage));
  const NormalError missed = CompareNormals(of({x}), of({black}));
  EXPECT_TRUE(std::isnan(missed.mean_deg));
  EXPECT_EQ(missed.coverage, 0);
}

TEST(ImageMetrics, TheRimIsAsWideOnBothSidesOfTheContour) {
  PixelMask mask{9, 7, std::vector<uint8_t>(63, 0)};
  for (int y = 0; y < 7; ++y) {
    for (int x = 5; x < 9; ++x) mask.inside[y * 9 + x] = 1;
  }
  const PixelMask rim = RimOf(mask, 2);
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < 9; ++x) EXPECT_EQ(rim.inside[y * 9 + x] != 0, x >= 3 && x <= 6) << x << ", " << y;
  }
  // Neither a picture that is all person nor one without a person has a contour, nor is there one of no width.
  for (const uint8_t value : {0, 1}) {
    const PixelMask rim_of_all = RimOf({9, 7, std::vector<uint8_t>(63, value)}, 2);
    EXPECT_EQ(std::count(rim_of_all.inside.begin(), rim_of_all.inside.end(), 0), 63);
  }
  const PixelMask none = RimOf(mask, 0);
  EXPECT_EQ(std::count(none.inside.begin(), none.inside.end(), 0), 63);
}

}  // namespace
}  // namespace bodyloom::image_metrics_test
