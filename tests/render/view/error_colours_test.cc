// SPDX-License-Identifier: Apache-2.0
#include "render/view/error_colours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "geometry/body/posed_body.h"
#include "render/view/attribute_image.h"
#include "render/view/caption.h"
#include "tests/support/toy_body.h"

namespace bodyloom::error_colours_test {
namespace {

/// CIELAB lightness (D65) of an sRGB colour.
double Lightness(Colour colour) {
  const auto linear = [](uint8_t value) {
    const double s = value / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  };
  const double y = 0.2126 * linear(colour.red) + 0.7152 * linear(colour.green) + 0.0722 * linear(colour.blue);
  return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
}

TEST(ErrorColours, LightnessRisesInAStraightLine) {
  const double first = Lightness(ErrorColour(0)), last = Lightness(ErrorColour(1));
  EXPECT_LT(first, 20);
  EXPECT_GT(last, 85);
  double before = -1;
  for (int i = 0; i <= 100; ++i) {
    const double lightness = Lightness(ErrorColour(i / 100.0));
    EXPECT_NEAR(lightness, first + (last - first) * i / 100, 2.5) << i;
    EXPECT_GE(lightness, before);
    before = lightness;
  }
}

TEST(ErrorColours, BeyondTheEndsAndUnknown) {
  EXPECT_EQ(ErrorColour(-1), ErrorColour(0));
  EXPECT_EQ(ErrorColour(1.5), ErrorColour(1));
  EXPECT_EQ(ErrorColour(std::numeric_limits<double>::infinity()), ErrorColour(1));
  const Colour unknown = ErrorColour(std::nan(""));
  EXPECT_EQ(unknown.red, unknown.green);
  EXPECT_EQ(unknown.red, unknown.blue);
  EXPECT_EQ((ErrorScale{50, "mm", "vertex error"}.ToText()), "vertex error: violet 0, yellow 50 mm and more");
}

TEST(ErrorColours, TheLegendShowsEveryColourInOrder) {
  const ErrorScale scale{2.5, "px", "projection error"};
  Image image(400, 120, {255, 255, 255});
  constexpr int kX = 30, kY = 20, kWidth = 320;
  constexpr double kCap = 10;
  DrawErrorLegend(scale, kX, kY, kWidth, kCap, &image);
  // Along the bar's middle row each pixel has its place's colour.
  const int row = kY + 26 + 7, from = kX + 9, width = kWidth - 18;
  for (int i = 0; i < width; i += 7) EXPECT_EQ(image.at(from + i, row), ErrorColour(i / (width - 1.0))) << i;
  const Colour white{255, 255, 255};
  int letters_above = 0, letters_left = 0, letters_middle = 0, letters_right = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const bool inside = x >= kX && x < kX + kWidth && y >= kY && y < kY + ErrorLegendHeight(kCap);
      EXPECT_EQ(image.at(x, y) == white, !inside) << x << ", " << y;
      const bool bright = inside && image.at(x, y).red > 200 && image.at(x, y).blue > 200;
      letters_above += bright && y < kY + 25 ? 1 : 0;
      if (!bright || y <= kY + 42) continue;
      ++(x < from + width / 4 ? letters_left : x < from + 5 * width / 8 ? letters_middle : letters_right);
    }
  }
  EXPECT_GT(letters_above, 100);
  EXPECT_GT(letters_left, 10);    // 0
  EXPECT_GT(letters_middle, 20);  // half of the maximum
  EXPECT_GT(letters_right, 50);   // the maximum with its unit
}

TEST(ErrorColours, NothingIsDrawnOutsideTheImage) {
  Image image(40, 30), untouched(40, 30);
  DrawErrorLegend({1, "mm", "a name that is far too long for this"}, -10, -10, 200, 12, &image);
  EXPECT_NE(image, untouched);
  Image beside(40, 30);
  DrawErrorLegend({1, "mm", "x"}, 50, 40, 100, 12, &beside);
  DrawWords("gone", 100, 10, 9, {255, 255, 255}, &beside);
  EXPECT_EQ(beside, untouched);
}

TEST(ErrorColours, WordsAreAsWideAsTheySay) {
  Image image(300, 60);
  DrawWords("gauge 120", 20, 40, 14, {255, 255, 255}, &image);
  int first = image.width, last = -1;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (image.at(x, y).red > 128) first = std::min(first, x), last = std::max(last, x);
    }
  }
  EXPECT_NEAR(first, 20, 3);
  EXPECT_NEAR(last, 20 + WidthOfWords("gauge 120", 14), 4);
}

/// Each pixel of a picture with one sample has the colour of its own interpolated error.
TEST(ErrorColours, OnASurfacePixelsHaveTheirErrorsColours) {
  const BodyModel& body = ToyBody();
  const MatrixX3d vertices = PoseVertices(body, {}, PoseFromAxisAngle(body, Eigen::VectorXd(), {0, 0, 3}));
  const Camera camera = MakePinhole(160, 200, 250);
  std::vector<float> errors(body.num_vertices());
  for (int v = 0; v < body.num_vertices(); ++v) errors[v] = static_cast<float>(40 + 50 * vertices(v, 1));
  AttributeImageOptions options;
  options.attribute = SurfaceAttribute::kError;
  options.vertex_errors = errors;
  options.error_maximum = 60;
  options.samples = 1;
  Image image(160, 200);
  AttributePainter().Draw(body, vertices, camera, options, &image);
  VisibilityBuffer buffer;
  buffer.Render(vertices, body.data().faces, camera);
  ResolvedPixels pixels;
  ResolveRequest request;
  request.vertex_attributes = {{errors, 1}};
  ResolvePixels(buffer, body, vertices, camera, request, &pixels);
  const PixelBox& box = buffer.box();
  int covered = 0;
  for (int y = box.y_begin; y < box.y_end; ++y) {
    for (int x = box.x_begin; x < box.x_end; ++x) {
      const size_t i = box.IndexOf(x, y);
      if (buffer.faces()[i] < 0) continue;
      ++covered;
      EXPECT_EQ(image.at(x, y), ErrorColour(pixels.vertex_attributes[0][i] / 60));
    }
  }
  EXPECT_GT(covered, 1000);
  options.error_maximum = 0;
  EXPECT_THROW(AttributePainter().Draw(body, vertices, camera, options, &image), std::invalid_argument);
  options.error_maximum = 60;
  options.vertex_errors = std::span(errors).first(10);
  EXPECT_THROW(AttributePainter().Draw(body, vertices, camera, options, &image), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::error_colours_test
