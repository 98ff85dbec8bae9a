// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <string>

#include <vector>

#include "render/view/side_panel.h"

#include "render/image/palette.h"
#include "render/view/caption.h"
#include "tests/support/toy_body.h"

namespace bodyloom::side_panel_test {
namespace {

using Eigen::Vector3d;

constexpr int kHeight = 600, kWidth = 450;
const std::vector<double> kTimes = {0, 0.1, 0.2};
const Floor kUnderFeet{Vector3d(0, 1, 0), -Vector3d::UnitY()};

/// The toy body's joints, upright with the lowest 10 cm over the floor, `scale` times as large, at (x, z).
SidePanelPerson At(double x, double z, double scale = 1) {
  MatrixX3d joints = scale * ToyBody().joint_template();
  joints.col(1) *= -1;  // y down
  joints.rowwise() += Eigen::RowVector3d(x, 0.9 - joints.col(1).maxCoeff(), z);
  return {std::vector<MatrixX3d>(kTimes.size(), joints)};
}

/// The same on its back, head away from the camera.
SidePanelPerson LyingAt(double x, double z) {
  MatrixX3d joints = ToyBody().joint_template();
  const Eigen::VectorXd up = joints.col(1), front = joints.col(2);
  joints.col(1) = -front;
  joints.col(2) = up;
  joints.rowwise() += Eigen::RowVector3d(x, 0.9 - joints.col(1).maxCoeff(), z);
  return {std::vector<MatrixX3d>(kTimes.size(), joints)};
}

FollowViewOptions Options() {
  FollowViewOptions options;
  options.orbit.elevation_deg = 8;
  options.width = kWidth;
  options.height = kHeight;
  return options;
}

SidePanel Panel(const std::vector<SidePanelPerson>& people) { return {people, kTimes, Options(), kUnderFeet}; }

/// The person's joints in its cell, pixels; all of them must be inside.
Eigen::MatrixX2d Pixels(const SidePanel& panel, int cell, const SidePanelPerson& person) {
  const SidePanel::Picture picture = panel.At(cell, 1);
  const MatrixX3d joints = picture.view.Apply(person.joints[1]);
  Eigen::MatrixX2d pixels(joints.rows(), 2);
  for (Eigen::Index j = 0; j < joints.rows(); ++j) {
    Eigen::Vector2d pixel;
    EXPECT_TRUE(picture.view.camera.Project(joints.row(j).transpose(), &pixel));
    EXPECT_TRUE(pixel.x() >= 0 && pixel.x() < picture.image.width && pixel.y() >= 0 && pixel.y() < picture.image.height)
        << "cell " << cell << ", joint " << j << ": " << pixel.transpose();
    pixels.row(j) = pixel.transpose();
  }
  return pixels;
}

double HeightIn(const Eigen::MatrixX2d& pixels) { return pixels.col(1).maxCoeff() - pixels.col(1).minCoeff(); }

TEST(SidePanel, SomebodyFarAwayMakesNobodySmall) {
  const SidePanelPerson near = At(0, 3);
  const Eigen::MatrixX2d beside = Pixels(Panel({near, At(0.5, 3.5)}), 0, near);
  const Eigen::MatrixX2d before = Pixels(Panel({near, At(-8, 60)}), 0, near);
  EXPECT_NEAR((beside - before).cwiseAbs().maxCoeff(), 0, 1e-6) << "the same pixels";
  const SidePanelPerson far = At(-8, 60);
  EXPECT_NEAR(HeightIn(Pixels(Panel({near, far}), 1, far)), HeightIn(before), 1e-6) << "and both are of one size";
}

TEST(SidePanel, EverybodyIsOverAQuarterOfThePanelsHeight) {
  const std::vector<SidePanelPerson> people = {At(0, 3), At(2, 7), At(-3, 12), At(1, 30)};
  for (size_t n = 1; n <= people.size(); ++n) {
    const SidePanel panel = Panel({people.begin(), people.begin() + static_cast<std::ptrdiff_t>(n)});
    ASSERT_EQ(panel.num_cells(), std::min<int>(static_cast<int>(n), SidePanel::kMostPeople));
    for (int k = 0; k < panel.num_cells(); ++k) {
      EXPECT_GT(HeightIn(Pixels(panel, k, people[size_t(k)])), kHeight / 3.5) << n << " people, " << k;
    }
  }
}

TEST(SidePanel, WhoStandsIsShownAbreastAndWhoLiesAboveEachOther) {
  const SidePanel standing = Panel({At(0, 3), At(1, 4)}), lying = Panel({LyingAt(0, 3), LyingAt(1, 4)});
  const Image abreast = standing.At(0, 0).image, above = lying.At(0, 0).image;
  EXPECT_EQ(abreast.height, kHeight);
  EXPECT_EQ(abreast.width, kWidth / 2);
  EXPECT_EQ(above.height, kHeight / 2);
  EXPECT_EQ(above.width, kWidth);
  for (const SidePanel* panel : {&standing, &lying}) {
    const Image joined = panel->Joined({panel->At(0, 0), panel->At(1, 0)});
    EXPECT_EQ(joined.width, kWidth);
    EXPECT_EQ(joined.height, kHeight);
  }
  EXPECT_THROW(lying.Joined({lying.At(0, 0)}), std::invalid_argument);
  EXPECT_THROW(lying.At(2, 0), std::invalid_argument);
}

TEST(SidePanel, WhoWouldBeTooSmallIsLeftOut) {
  // Of giants of 8 m a metre would be less than a seventh of the panel's height.
  EXPECT_EQ(Panel({At(0, 20, 5), At(3, 20, 5), At(6, 20, 5)}).num_cells(), 1);
  EXPECT_THROW(Panel({}), std::invalid_argument);
}

TEST(SidePanel, TheFloorBelowIsKeptInView) {
  SidePanelPerson lifted = At(0, 3);
  for (MatrixX3d& joints : lifted.joints) joints.col(1).array() -= 0.3;
  const SidePanel panel = Panel({lifted});
  const SidePanel::Picture picture = panel.At(0, 1);
  MatrixX3d below(1, 3);
  below << lifted.joints[1](0, 0), kUnderFeet.point.y(), lifted.joints[1](0, 2);
  Eigen::Vector2d pixel;
  ASSERT_TRUE(picture.view.camera.Project(picture.view.Apply(below).row(0).transpose(), &pixel));
  EXPECT_LT(pixel.y(), kHeight);
}

TEST(SidePanel, TheFloorIsAtTheLevelUnderThePerson) {
  SidePanelPerson person = At(0, 3);
  for (MatrixX3d& joints : person.joints) joints.col(1).array() -= 0.45;
  person.level_m = (Eigen::VectorXd(3) << 0, 0.45, 0).finished();
  const SidePanel panel = Panel({person});
  for (const int t : {0, 1}) {
    const SidePanel::Picture picture = panel.At(0, t);
    MatrixX3d lowest(1, 3);
    lowest = person.joints[1].row(0);
    lowest(0, 1) = person.joints[1].col(1).maxCoeff();
    const Vector3d in_view = picture.view.Apply(lowest).row(0).transpose();
    EXPECT_NEAR(picture.floor.up.dot(in_view - picture.floor.point), t == 1 ? 0.1 : 0.55, 1e-9) << t;
  }
  EXPECT_NE(panel.At(0, 0).image, panel.At(0, 1).image);
  person.level_m.conservativeResize(2);
  EXPECT_THROW(Panel({person}), std::invalid_argument);
}

TEST(SidePanel, ShadowIsStraightBelowABodyThatHovers) {
  const Camera camera = MakePinhole(200, 200, 150);
  MatrixX3d square(4, 3);  // 1 m above a floor that a camera sees from 1 m above the square
  square << -0.1, 0, 3, 0.1, 0, 3, 0.1, 0, 3.2, -0.1, 0, 3.2;
  MatrixX3i faces(2, 3);
  faces << 0, 1, 2, 0, 2, 3;
  const auto mean_column = [&](const Eigen::Vector2d& slant) {
    Image image(200, 200, {200, 200, 200});
    DrawShadow(square, faces, {Vector3d(0, 1, 0), -Vector3d::UnitY()}, camera, 0.5, &image, slant);
    double sum = 0, weight = 0;
    for (int y = 0; y < 200; ++y) {
      for (int x = 0; x < 200; ++x) {
        const double dark = 200 - image.at(x, y).red;
        sum += dark * x, weight += dark;
      }
    }
    EXPECT_GT(weight, 100);
    return sum / weight;
  };
  EXPECT_NEAR(mean_column({0, 0}), 99.5, 1);
  EXPECT_NEAR(mean_column({0.5, 0}), 99.5 + 0.5 * 150 / 3.1, 3) << "half a metre to the right";
}

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
  const auto red_beside = [&](double y, double across) {
    return image.at(static_cast<int>(std::lround(from.x() + across)), static_cast<int>(std::lround(y))).red;
  };
  for (const double y : {from.y(), to.y()}) EXPECT_LT(red_beside(y, 0.25 * kCapPx), 150) << "a bar";
  for (double across = 0.6 * kCapPx; across < 1.3 * kCapPx; across += 1) {
    EXPECT_GT(red_beside(0.5 * (from.y() + to.y()), across), 190) << "the line is not a digit of the number";
  }
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

}  // namespace bodyloom::side_panel_test
