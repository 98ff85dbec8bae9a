// SPDX-License-Identifier: Apache-2.0
#include "render/view/ground_marks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "render/image/palette.h"
#include "render/view/caption.h"

namespace bodyloom::ground_marks_test {
namespace {

using Eigen::Vector3d;

// The floor is 1 m below a level camera and seen from 3 m.
const Camera kCamera = MakePinhole(640, 480, 500);
const Floor kLevelFloor{Vector3d(0, 1, 0), -Vector3d::UnitY()};
constexpr double kCapPx = 10;
constexpr Colour kPlain{200, 200, 200};

/// Two feet of 22 cm, 30 cm apart, each a row of vertices, and a head; the feet `height` metres over the floor.
MatrixX3d Standing(double height) {
  MatrixX3d vertices(47, 3);
  for (int side = 0; side < 2; ++side) {
    for (int k = 0; k < 23; ++k) vertices.row(23 * side + k) << 0.3 * side - 0.15, 1 - height, 3 + 0.01 * k;
  }
  vertices.row(46) << 0, -0.6, 3;
  return vertices;
}

Image Drawn(const FloorContact& contact) {
  Image image(kCamera.width, kCamera.height, kPlain);
  DrawFloorContact(contact, kLevelFloor, kCamera, kCapPx, &image);
  return image;
}

int Count(const Image& image, bool (*is)(const Colour&)) {
  int count = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) count += is(image.at(x, y));
  }
  return count;
}

bool IsGreen(const Colour& c) { return c.green > c.red + 80; }
bool IsRed(const Colour& c) { return c.red > c.green + 80; }
bool IsDark(const Colour& c) { return c.red < 60 && c.green < 60 && c.blue < 80; }

/// True if the words stand somewhere in the picture, letter by letter and pixel by pixel.
bool Shows(const Image& image, const std::string& words, const Colour& colour) {
  const int width = static_cast<int>(WidthOfWords(words, kCapPx)) + 4, height = static_cast<int>(1.5 * kCapPx);
  Image letters(width, height, kPlain);
  DrawWords(words, 2, height - 4, kCapPx, colour, &letters);
  for (int y_0 = 0; y_0 + height <= image.height; ++y_0) {
    for (int x_0 = 0; x_0 + width <= image.width; ++x_0) {
      int wrong = 0;
      for (int y = 0; y < height && wrong == 0; ++y) {
        for (int x = 0; x < width && wrong == 0; ++x) {
          wrong += !(letters.at(x, y) == kPlain) && !(letters.at(x, y) == image.at(x_0 + x, y_0 + y));
        }
      }
      if (wrong == 0) return true;
    }
  }
  return false;
}

TEST(FloorContact, FeetOnTheFloorTouchItAtBothEnds) {
  const FloorContact contact = ContactWithFloor(Standing(0), kLevelFloor);
  EXPECT_NEAR(contact.lowest_m, 0, 1e-12);
  ASSERT_EQ(contact.touching.size(), 4U) << "two of each foot, more than 12 cm apart";
  for (const Vector3d& point : contact.touching) EXPECT_NEAR(point.y(), 1, 1e-12);
}

TEST(FloorContact, HeightIsAlongTheFloorsVertical) {
  const FloorContact above = ContactWithFloor(Standing(0.1), kLevelFloor);
  EXPECT_NEAR(above.lowest_m, 0.1, 1e-12);
  EXPECT_TRUE(above.touching.empty());
  EXPECT_NEAR(ContactWithFloor(Standing(-0.05), kLevelFloor).lowest_m, -0.05, 1e-12);
  // Tilted by 30° about the camera's x axis, with a vertical of length 2.
  const Floor tilted{Vector3d(0, 1, 3), 2 * Vector3d(0, -std::cos(M_PI / 6), -0.5)};
  MatrixX3d point(1, 3);
  point.row(0) = (tilted.point + 0.07 * tilted.up / 2 + 0.4 * Vector3d::UnitX()).transpose();
  EXPECT_NEAR(ContactWithFloor(point, tilted).lowest_m, 0.07, 1e-12);
  EXPECT_THROW(ContactWithFloor(MatrixX3d(0, 3), kLevelFloor), std::invalid_argument);
}

TEST(FloorContact, WhatPassesThroughTheFloorDoesNotTouchIt) {
  MatrixX3d leg(11, 3);  // a vertical row of vertices from 10 cm below the floor to 10 cm above it
  for (int k = 0; k < 11; ++k) leg.row(k) << 0, 1.1 - 0.02 * k, 3;
  const FloorContact contact = ContactWithFloor(leg, kLevelFloor);
  EXPECT_NEAR(contact.lowest_m, -0.1, 1e-12);
  EXPECT_TRUE(contact.touching.empty());
  // One foot below the floor, the other on it.
  MatrixX3d uneven = Standing(0);
  uneven.topRows(23).col(1).array() += 0.06;
  EXPECT_NEAR(ContactWithFloor(uneven, kLevelFloor).lowest_m, -0.06, 1e-12);
  EXPECT_EQ(ContactWithFloor(uneven, kLevelFloor).touching.size(), 2U);
}

TEST(FloorContact, ABodyOnTheFloorHasDiscsAndNoLine) {
  const Image image = Drawn(ContactWithFloor(Standing(0), kLevelFloor));
  EXPECT_GT(Count(image, IsGreen), 20);
  EXPECT_EQ(Count(image, IsRed), 0);
  EXPECT_FALSE(Shows(image, "0 cm", kInkColour));
  EXPECT_EQ(Drawn(ContactWithFloor(Standing(0), kLevelFloor)), image) << "same input, same bytes";
}

TEST(FloorContact, ALiftedBodyHasALineDownToTheFloorAndItsHeight) {
  const FloorContact contact = ContactWithFloor(Standing(0.1), kLevelFloor);
  const Image image = Drawn(contact);
  EXPECT_EQ(Count(image, IsGreen) + Count(image, IsRed), 0);
  EXPECT_TRUE(Shows(image, "10 cm", kInkColour));
  EXPECT_FALSE(Shows(image, "11 cm", kInkColour));
  EXPECT_FALSE(Shows(image, "10 cm", kPaperColour)) << "the search itself can fail";
  Eigen::Vector2d from, to;
  ASSERT_TRUE(kCamera.Project(contact.lowest, &from));
  ASSERT_TRUE(kCamera.Project(contact.lowest + Vector3d(0, 0.1, 0), &to));
  ASSERT_GT(to.y() - from.y(), 10);
  const auto is_dark = [&](int row) {  // the line may lie between two columns, half as dark in each
    const int x = static_cast<int>(std::lround(from.x()));
    return std::min({image.at(x - 1, row).red, image.at(x, row).red, image.at(x + 1, row).red}) < 130;
  };
  for (int y = static_cast<int>(from.y()) + 1; y < static_cast<int>(to.y()); ++y) EXPECT_TRUE(is_dark(y)) << y;
  EXPECT_FALSE(is_dark(static_cast<int>(from.y()) - 3));
  EXPECT_FALSE(is_dark(static_cast<int>(to.y()) + 3));
}

TEST(FloorContact, BelowTheFloorIsRed) {
  const Image image = Drawn(ContactWithFloor(Standing(-0.08), kLevelFloor));
  EXPECT_GT(Count(image, IsRed), 20);
  EXPECT_EQ(Count(image, IsDark) + Count(image, IsGreen), 0);
  EXPECT_TRUE(Shows(image, "-8 cm", {214, 40, 40}));
}

TEST(FloorContact, WhatTheCameraDoesNotSeeIsNotDrawn) {
  FloorContact behind;
  behind.lowest_m = 0.3;
  behind.lowest = {0, 0.7, -2};
  behind.touching = {{0, 1, -2}};
  EXPECT_EQ(Drawn(behind), Image(kCamera.width, kCamera.height, kPlain));
}

}  // namespace
}  // namespace bodyloom::ground_marks_test
