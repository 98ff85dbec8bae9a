// SPDX-License-Identifier: Apache-2.0
#include "render/view/side_panel.h"

#include <gtest/gtest.h>

#include <vector>

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

}  // namespace
}  // namespace bodyloom::side_panel_test
