// SPDX-License-Identifier: Apache-2.0
#include "tracking/clip/camera_scale.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"

namespace bodyloom::camera_scale_test {
namespace {

using Eigen::Vector3d;

/// A person who walks beside a camera: each foot stands for half a second, then goes 0.7 m ahead.
struct WalkBeside {
  std::vector<std::array<FootPlace, 2>> feet;
  std::vector<double> timestamps;
  std::vector<char> cut_before;
  std::vector<CameraPose> unit_path;

  /// `scale`: metres a unit; `slide`: of standing feet in the scene, m/s, during the share `sliding` of the clip.
  explicit WalkBeside(double scale, double slide = 0, double sliding = 0) {
    constexpr int kFrames = 60;
    for (int t = 0; t < kFrames; ++t) {
      const double seconds = t / 15.0;
      const Vector3d centre(1.1 * seconds, 0.05 * std::sin(5 * seconds), 0);
      CameraPose camera{RotationFromAxisAngle({0.02 * std::sin(seconds), 0.1 * std::cos(seconds), 0}), {}};
      camera.camera_from_world_translation = -camera.camera_from_world_rotation * centre;
      std::array<FootPlace, 2> both;
      for (int foot = 0; foot < 2; ++foot) {
        const double phase = seconds + 0.5 * foot;
        const double step = std::floor(phase), in_step = phase - step;
        Vector3d ankle(1.1 * step - 0.55 * foot, 1.4, 4 + 0.2 * foot);
        both[foot].contact = in_step < 0.55 ? 0.9 : 0.1;
        if (in_step >= 0.55) ankle.x() += 1.1 * (in_step - 0.55) / 0.45;
        if (t < sliding * kFrames) ankle.x() += slide * seconds;
        both[foot].seen = true;
        both[foot].ankle_m = MovedPoint(camera, ankle);
      }
      feet.push_back(both);
      timestamps.push_back(seconds);
      cut_before.push_back(0);
      camera.camera_from_world_translation /= scale;
      unit_path.push_back(camera);
    }
  }
  [[nodiscard]] CameraScale Estimate() const {
    return EstimateCameraScale({&feet, 1}, timestamps, cut_before, unit_path);
  }
};

TEST(CameraScale, IsExactWhereFeetStand) {
  for (const double scale : {0.3, 1.0, 7.5}) {
    WalkBeside walk(scale);
    for (auto& both : walk.feet) {
      for (FootPlace& foot : both) foot.seen = foot.contact > 0.5;  // while feet swing neither may stand
    }
    const CameraScale found = walk.Estimate();
    ASSERT_TRUE(found.found) << found.why;
    EXPECT_NEAR(found.scale_m, scale, 1e-9 * scale);
    EXPECT_GT(found.sigma_m, 0);
    EXPECT_LT(found.sigma_m, 0.1 * scale);
  }
}

TEST(CameraScale, FeetThatSlideForAThirdOfTheClipAreOutvoted) {
  const CameraScale found = WalkBeside(2, 0.8, 0.3).Estimate();
  ASSERT_TRUE(found.found) << found.why;
  // The kernel lets the middle of a sliding run count, which hardly deviates from its mean.
  EXPECT_NEAR(found.scale_m, 2, 0.1);
}

TEST(CameraScale, OneOfTwoFeetStandsWhicheverItIs) {
  for (const double scale : {0.3, 1.0, 7.5}) {
    WalkBeside walk(scale);
    for (auto& both : walk.feet) both[0].contact = both[1].contact = 0;  // the lifter takes both for swinging
    const CameraScale found = walk.Estimate();
    ASSERT_TRUE(found.found) << found.why;
    EXPECT_NEAR(found.scale_m, scale, 0.02 * scale);  // while the feet change, neither stands
    EXPECT_LT(found.sigma_m, 0.2 * scale);
    EXPECT_THAT(found.why, testing::HasSubstr("one of both feet"));
  }
}

TEST(CameraScale, OtherPointsOfTheFeetStandForAnklesThatAreNotSeen) {
  WalkBeside walk(2);
  const std::vector<std::array<FootPlace, 2>> toes = walk.feet;
  for (auto& both : walk.feet) both[0].seen = both[1].seen = false;
  EXPECT_FALSE(walk.Estimate().found);
  const std::array<std::vector<std::array<FootPlace, 2>>, 2> points = {walk.feet, toes};
  const CameraScale found = EstimateCameraScale(points, walk.timestamps, walk.cut_before, walk.unit_path);
  ASSERT_TRUE(found.found) << found.why;
  EXPECT_NEAR(found.scale_m, 2, 0.04);
}

TEST(CameraScale, FeetThatNeverStandTellNothing) {
  WalkBeside skating(1);
  for (size_t t = 0; t < skating.feet.size(); ++t) {
    for (FootPlace& foot : skating.feet[t]) {
      foot.contact = 0;
      const double seconds = skating.timestamps[t];
      foot.ankle_m = Vector3d(std::sin(7 * seconds + 3 * double(&foot - skating.feet[t].data())), 1.4,
                              4 + std::cos(5 * seconds));  // in the camera frame, whatever the camera does
    }
  }
  EXPECT_FALSE(skating.Estimate().found);
  WalkBeside broken(1);
  for (auto& both : broken.feet) both[0].ankle_m.setConstant(std::nan("")), both[1].seen = false;
  EXPECT_FALSE(broken.Estimate().found);
}

TEST(CameraScale, SaysWhyThereIsNone) {
  WalkBeside still(1);
  for (CameraPose& camera : still.unit_path) camera.camera_from_world_translation.setZero();
  EXPECT_FALSE(still.Estimate().found);
  WalkBeside hidden(1);
  for (auto& both : hidden.feet) both[0].seen = both[1].seen = false;
  const CameraScale none = hidden.Estimate();
  EXPECT_FALSE(none.found);
  EXPECT_THAT(none.why, testing::HasSubstr("no foot"));
  WalkBeside barely(1);
  for (size_t t = 0; t < barely.unit_path.size(); ++t) {
    // Every frame a shot of its own.
    barely.cut_before[t] = 1;
  }
  EXPECT_FALSE(barely.Estimate().found);
  EXPECT_THROW(EstimateCameraScale({&still.feet, 1}, still.timestamps, {}, still.unit_path), std::invalid_argument);
}

/// The floor of WalkBeside, whose ankles stand at y = 1.4 m, in units.
PointsFloor FloorAt(double scale) {
  PointsFloor floor;
  floor.found = true;
  floor.up = Vector3d(0, -1, 0);
  floor.height = (1.4 + kAnkleHeight) / scale;
  floor.covariance = 1e-8 * Eigen::Matrix3d::Identity();
  return floor;
}

TEST(CameraScale, FeetOnTheFloorTellItWhateverTheySlide) {
  for (const double scale : {0.3, 1.0, 7.5}) {
    WalkBeside walk(scale, 0.8, 1);
    for (size_t t = 0; t < 20; ++t) {  // jumps
      for (FootPlace& foot : walk.feet[t]) {
        foot.ankle_m -= walk.unit_path[t].camera_from_world_rotation * Vector3d(0, 0.3, 0);
      }
    }
    const CameraScale found =
        ScaleByFloor({&walk.feet, 1}, std::array{kAnkleHeight}, walk.timestamps, walk.unit_path, FloorAt(scale));
    ASSERT_TRUE(found.found) << found.why;
    EXPECT_NEAR(found.scale_m, scale, 1e-3 * scale);  // the kernel's tail at a jump
    EXPECT_GT(found.sigma_m, 0.005 * scale);
    EXPECT_LT(found.sigma_m, 0.04 * scale);
  }
  WalkBeside walk(1);
  EXPECT_FALSE(
      ScaleByFloor({&walk.feet, 1}, std::array{kAnkleHeight}, walk.timestamps, walk.unit_path, PointsFloor()).found);
  for (auto& both : walk.feet) both[0].seen = both[1].seen = false;
  EXPECT_FALSE(
      ScaleByFloor({&walk.feet, 1}, std::array{kAnkleHeight}, walk.timestamps, walk.unit_path, FloorAt(1)).found);
  EXPECT_THROW(ScaleByFloor({&walk.feet, 1}, {}, walk.timestamps, walk.unit_path, FloorAt(1)), std::invalid_argument);
}

TEST(CameraScale, OfFeetAndOfTheFloorJoinBySigma) {
  const CameraScale feet{true, "feet", 2, 0.2}, floor{true, "floor", 2.2, 0.11}, none;
  const CameraScale joined = JoinScales(feet, floor);
  ASSERT_TRUE(joined.found);
  // Weights 100 and 400; the body's size is an error of both.
  EXPECT_NEAR(std::log(joined.scale_m), (std::log(2.0) + 4 * std::log(2.2)) / 5, 1e-12);
  EXPECT_NEAR(joined.sigma_m, joined.scale_m * std::sqrt(1 / 500.0 + 0.04 * 0.04), 1e-12);
  EXPECT_EQ(JoinScales(feet, none).scale_m, 2);
  EXPECT_NEAR(JoinScales(feet, none).sigma_m, 2 * std::hypot(0.1, 0.04), 1e-12);
  EXPECT_EQ(JoinScales(none, floor).scale_m, 2.2);
  EXPECT_FALSE(JoinScales(none, none).found);
}

TEST(CameraScale, FeetThatRollOnAllTheWayAreWithinItsSigma) {
  CameraScaleOptions sharp;
  sharp.across_m = 0.003;
  sharp.along_m = 0.012;
  for (const double slide : {-0.05, 0.05}) {
    const WalkBeside walk(2, slide, 1);
    const CameraScale found =
        EstimateCameraScale({&walk.feet, 1}, walk.timestamps, walk.cut_before, walk.unit_path, sharp);
    ASSERT_TRUE(found.found) << found.why;
    EXPECT_NEAR(std::abs(found.scale_m - 2), 2 * 0.05 / 1.1, 0.02);  // the slide is a part of the camera's way
    EXPECT_LT(std::abs(found.scale_m - 2), 1.5 * found.sigma_m);
    EXPECT_LT(found.sigma_m, 0.12);
  }
}

/// Somebody sways in one place, or goes along, before a camera that goes round by a right angle in six seconds.
struct GoRound {
  std::vector<Vector3d> places;
  std::vector<double> timestamps;
  std::vector<char> cut_before;
  std::vector<CameraPose> unit_path;

  GoRound(double scale, double walk_mps, double turn) {
    for (int t = 0; t < 90; ++t) {
      const double seconds = t / 15.0, angle = turn * seconds / 6;
      const Vector3d person(0.05 * std::sin(3 * seconds) + walk_mps * seconds, 0, 3 + 0.03 * std::cos(5 * seconds));
      const Vector3d middle(walk_mps * seconds, 0, 3);
      const Vector3d centre = middle - 3 * Vector3d(std::sin(angle), 0, std::cos(angle));
      CameraPose camera{RotationFromAxisAngle({0, -angle, 0}), {}};
      camera.camera_from_world_translation = -camera.camera_from_world_rotation * centre;
      places.push_back(MovedPoint(camera, person));
      timestamps.push_back(seconds);
      cut_before.push_back(0);
      camera.camera_from_world_translation /= scale;
      unit_path.push_back(camera);
    }
  }
  [[nodiscard]] CameraScale Estimate() const { return ScaleByPlace(places, timestamps, cut_before, unit_path); }
};

TEST(CameraScale, SomebodyWhoStaysTellsItToACameraThatGoesRound) {
  for (const double scale : {0.3, 1.0, 7.5}) {
    const CameraScale found = GoRound(scale, 0, M_PI / 2).Estimate();
    ASSERT_TRUE(found.found) << found.why;
    EXPECT_NEAR(found.scale_m, scale, 0.05 * scale);
    EXPECT_GT(found.sigma_m, 0.1 * scale);  // who stays may still go slowly
    EXPECT_LT(found.sigma_m, 0.25 * scale);
  }
}

TEST(CameraScale, SomebodyWhoWalksDoesNot) {
  EXPECT_FALSE(GoRound(2, 1.3, M_PI / 2).Estimate().found);
  EXPECT_FALSE(GoRound(2, 1.3, 0).Estimate().found);
  EXPECT_FALSE(GoRound(2, 0, 0).Estimate().found);  // nor does a camera that stands
  GoRound cut(2, 0, M_PI / 2);
  std::fill(cut.cut_before.begin(), cut.cut_before.end(), 1);
  EXPECT_FALSE(cut.Estimate().found);
  EXPECT_THROW(ScaleByPlace(cut.places, cut.timestamps, {}, cut.unit_path), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::camera_scale_test
