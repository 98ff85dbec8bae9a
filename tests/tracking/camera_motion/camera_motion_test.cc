// SPDX-License-Identifier: Apache-2.0
// Rotations, focal lengths and verdicts from points whose camera is known.
#include "tracking/camera_motion/camera_motion.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "geometry/base/units.h"
#include "tests/tracking/camera_motion/synthetic_background.h"
#include "tracking/camera_motion/turning_camera.h"

namespace bodyloom::camera_motion_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

CameraMotionOptions UnknownFocal(const SyntheticBackground& scene) {
  return {.focal = FocalPrior::ForImage(scene.width, scene.height)};
}

/// Root mean square of the angles between the path's rotations and the true ones, degrees.
double RotationErrorDeg(const SyntheticBackground& scene, const CameraMotion& motion) {
  double sum = 0;
  const Eigen::Matrix3d first = scene.pose(0).camera_from_world_rotation;
  for (size_t i = 0; i < motion.path.poses.size(); ++i) {
    const Eigen::Matrix3d truth = scene.pose(motion.path.timestamps[i]).camera_from_world_rotation * first.transpose();
    sum += std::pow(RotationAngleBetween(truth, motion.path.poses[i].camera_from_world_rotation) / kDegree, 2);
  }
  return std::sqrt(sum / static_cast<double>(motion.path.poses.size()));
}

TEST(TurnedPointCost, DerivativesAreThoseOfDifferences) {
  const Vector2d from(310, -170);
  // Generic; no rotation; a zero residual; a large turn.
  const std::vector<std::array<Vector3d, 2>> rotations = {{{{0.1, -0.2, 0.05}, {0.15, 0.3, -0.1}}},
                                                          {{Vector3d::Zero(), Vector3d::Zero()}},
                                                          {{{0.02, 0.01, 0}, {0.02, 0.01, 0}}},
                                                          {{{0, 2.2, 0}, {0.1, 2.4, 0.1}}}};
  for (const auto& [w_from, w_to] : rotations) {
    const TurnedPointCost cost(from, from, 0.7);
    std::array<double, 9> x = {w_from.x(), w_from.y(),      w_from.z(), w_to.x(), w_to.y(),
                               w_to.z(),   std::log(900.0), 0.02,       -0.03};
    if (w_from == w_to) x[7] = x[8] = 0;
    const std::array<const double*, 5> blocks = {&x[0], &x[3], &x[6], &x[7], &x[8]};
    std::array<std::array<double, 6>, 5> jacobians{};
    std::array<double*, 5> pointers{};
    for (size_t b = 0; b < 5; ++b) pointers[b] = jacobians[b].data();
    std::array<double, 2> residuals{}, above{}, below{};
    ASSERT_TRUE(cost.Evaluate(blocks.data(), residuals.data(), pointers.data()));
    if (w_from == w_to) {
      EXPECT_NEAR(std::hypot(residuals[0], residuals[1]), 0, 1e-9);
    }
    const std::array<int, 5> first = {0, 3, 6, 7, 8}, size = {3, 3, 1, 1, 1};
    for (size_t b = 0; b < 5; ++b) {
      for (int k = 0; k < size[b]; ++k) {
        double& at = x[size_t(first[b] + k)];
        const double before = at, step = 1e-6;
        at = before + step;
        ASSERT_TRUE(cost.Evaluate(blocks.data(), above.data(), nullptr));
        at = before - step;
        ASSERT_TRUE(cost.Evaluate(blocks.data(), below.data(), nullptr));
        at = before;
        for (size_t r = 0; r < 2; ++r) {
          const double expected = (above[r] - below[r]) / (2 * step);
          EXPECT_NEAR(jacobians[b][r * size_t(size[b]) + size_t(k)], expected, 1e-5 * (1 + std::abs(expected)))
              << "block " << b << ", " << k << ", row " << r;
        }
      }
    }
  }
}

TEST(TurnedPointCost, APointBehindTheCameraIsNotValid) {
  const TurnedPointCost cost({10, 20}, {10, 20}, 1);
  const std::array<double, 3> none{}, half_turn = {0, M_PI, 0};
  const double log_focal = 7, zoom = 0, other_zoom = 0;
  const std::array<const double*, 5> blocks = {none.data(), half_turn.data(), &log_focal, &zoom, &other_zoom};
  std::array<double, 2> residuals{};
  EXPECT_FALSE(cost.Evaluate(blocks.data(), residuals.data(), nullptr));
}

TEST(CameraMotion, StillIsStillUnderNoiseAndPeopleWhoAreNotMasked) {
  for (const double wanderers : {0.0, 0.3, 0.5}) {
    SyntheticBackground scene;
    scene.noise_px = 0.4;
    scene.wanderers = wanderers;
    const CameraMotion motion = FindCameraMotion(TracksOf(scene), UnknownFocal(scene));
    EXPECT_EQ(motion.kind, CameraMotionKind::kStill) << wanderers << ": " << motion.why;
    EXPECT_FALSE(motion.has_path());
  }
}

TEST(CameraMotion, LeavesThatFillThePictureAreNoMotionOfTheCamera) {
  SyntheticBackground scene;
  scene.wanderers = 0.9;
  EXPECT_EQ(FindCameraMotion(TracksOf(scene), UnknownFocal(scene)).kind, CameraMotionKind::kStill);
}

TEST(CameraMotion, TremorIsFoundWithItsFocalLength) {
  for (const double degrees : {0.5, 1.5, 3.0}) {
    SyntheticBackground scene;
    scene.pose = [degrees](double t) { return Tremor(t, degrees); };
    scene.wanderers = 0.15;
    const CameraMotion motion = FindCameraMotion(TracksOf(scene), UnknownFocal(scene));
    ASSERT_EQ(motion.kind, CameraMotionKind::kTurning) << degrees << ": " << motion.why;
    EXPECT_LT(RotationErrorDeg(scene, motion), 0.02) << degrees;
    EXPECT_NEAR(motion.log_focal, std::log(scene.focal_px), 0.03) << degrees;
    EXPECT_LT(std::abs(motion.log_focal - std::log(scene.focal_px)), 5 * motion.log_focal_sigma) << degrees;
    EXPECT_EQ(motion.zoom, 1);
  }
}

TEST(CameraMotion, APanIsCarriedFromAnchorToAnchor) {
  SyntheticBackground scene;
  scene.frames = 150;
  scene.frames_of_anchor = 12;
  scene.pose = [](double t) {
    return CameraPose{RotationFromAxisAngle({0, 0.7 * std::sin(1.2 * t), 0}), Vector3d::Zero()};
  };
  const CameraMotion motion = FindCameraMotion(TracksOf(scene), UnknownFocal(scene));
  ASSERT_EQ(motion.kind, CameraMotionKind::kTurning) << motion.why;
  EXPECT_LT(RotationErrorDeg(scene, motion), 0.1);
  EXPECT_NEAR(motion.log_focal, std::log(scene.focal_px), 0.01);
  EXPECT_NEAR(motion.turned_deg, 0.7 / kDegree, 1);
}

TEST(CameraMotion, AZoomIsNoted) {
  SyntheticBackground scene;
  scene.pose = [](double t) { return Tremor(t, 1); };
  scene.zoom = [](double t) { return 1 + 0.1 * t; };
  const CameraMotion motion = FindCameraMotion(TracksOf(scene), UnknownFocal(scene));
  ASSERT_EQ(motion.kind, CameraMotionKind::kTurning) << motion.why;
  EXPECT_NEAR(motion.zoom, 1 + 0.1 * (scene.frames - 1) / scene.fps, 0.01);
  EXPECT_LT(RotationErrorDeg(scene, motion), 0.05);
}

TEST(CameraMotion, TheReversedClipHasTheReversedPath) {
  SyntheticBackground scene;
  scene.pose = [](double t) { return Tremor(t, 2); };
  SyntheticBackground reversed = scene;
  const double last = (scene.frames - 1) / scene.fps;
  reversed.pose = [last](double t) { return Tremor(last - t, 2); };
  const CameraMotion there = FindCameraMotion(TracksOf(scene), UnknownFocal(scene));
  const CameraMotion back = FindCameraMotion(TracksOf(reversed), UnknownFocal(scene));
  ASSERT_EQ(there.path.poses.size(), back.path.poses.size());
  const Eigen::Matrix3d whole = there.path.poses.back().camera_from_world_rotation,
                        whole_back = back.path.poses.back().camera_from_world_rotation;
  EXPECT_LT(RotationAngleBetween(whole, whole_back.transpose()) / kDegree, 0.03);
}

TEST(CameraMotion, TextThatStaysInPlaceIsLeftOut) {
  SyntheticBackground scene;
  scene.pose = [](double t) { return Tremor(t, 2); };
  scene.overlay = 0.2;
  const CameraMotion motion = FindCameraMotion(TracksOf(scene), UnknownFocal(scene));
  ASSERT_EQ(motion.kind, CameraMotionKind::kTurning) << motion.why;
  EXPECT_LT(RotationErrorDeg(scene, motion), 0.03);
}

TEST(CameraMotion, ACameraThatGoesSomewhereMoves) {
  SyntheticBackground scene;
  scene.nearest_m = 3;
  scene.farthest_m = 12;
  scene.pose = [](double t) {
    CameraPose pose = Tremor(t, 1);
    pose.camera_from_world_translation = Vector3d(-0.3 * t, 0.02 * std::sin(6 * t), 0.1 * t);
    return pose;
  };
  const CameraMotion motion = FindCameraMotion(TracksOf(scene), UnknownFocal(scene));
  EXPECT_EQ(motion.kind, CameraMotionKind::kMoving) << motion.why;
  ASSERT_TRUE(motion.has_path()) << motion.why;
  EXPECT_EQ(motion.path.poses.size(), size_t(scene.frames));
  EXPECT_EQ(motion.sigma_place.size(), size_t(scene.frames));
  EXPECT_GT(motion.extent, 0.1);
  EXPECT_GT(motion.points.size(), 50u);
  EXPECT_NE(motion.why.find("points in space"), std::string::npos) << motion.why;
}

TEST(CameraMotion, AStatedDeviationIsThatOfTheErrors) {
  double normal = 0;
  int count = 0;
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    SyntheticBackground scene;
    scene.seed = seed;
    scene.pose = [](double t) { return Tremor(t, 2); };
    const CameraMotion motion = FindCameraMotion(TracksOf(scene), UnknownFocal(scene));
    ASSERT_EQ(motion.sigma_rad.size(), motion.path.poses.size());
    for (size_t i = 1; i < motion.path.poses.size(); ++i) {
      const double off = RotationAngleBetween(scene.pose(motion.path.timestamps[i]).camera_from_world_rotation,
                                              motion.path.poses[i].camera_from_world_rotation);
      normal += off * off / (3 * motion.sigma_rad[i] * motion.sigma_rad[i]);
      ++count;
    }
  }
  EXPECT_GT(std::sqrt(normal / count), 0.4);
  EXPECT_LT(std::sqrt(normal / count), 2);
}

TEST(CameraMotion, AnEndThatIsNotSeenIsHeldWithALargerDeviation) {
  SyntheticBackground scene;
  scene.pose = [](double t) { return Tremor(t, 2); };
  BackgroundTracks tracks = TracksOf(scene);
  tracks.anchors[0].sights.resize(75);
  const CameraMotion motion = FindCameraMotion(tracks, UnknownFocal(scene));
  ASSERT_EQ(motion.kind, CameraMotionKind::kTurning) << motion.why;
  ASSERT_EQ(motion.path.timestamps.size(), 77u);
  EXPECT_EQ(motion.path.timestamps.back(), tracks.timestamps.back());
  EXPECT_TRUE(motion.path.poses[76].camera_from_world_rotation == motion.path.poses[75].camera_from_world_rotation);
  EXPECT_GT(motion.sigma_rad[76], 20 * motion.sigma_rad[75]);
  tracks.anchors[0].sights.resize(50);  // more than a second
  EXPECT_EQ(FindCameraMotion(tracks, UnknownFocal(scene)).kind, CameraMotionKind::kMoving);
}

TEST(CameraMotion, TooFewPointsSayNothing) {
  SyntheticBackground scene;
  scene.points = 60;  // some eight in view
  scene.pose = [](double t) { return Tremor(t, 2); };
  EXPECT_EQ(FindCameraMotion(TracksOf(scene), UnknownFocal(scene)).kind, CameraMotionKind::kUnknown);
  BackgroundTracks nothing;
  nothing.width = 64;
  nothing.height = 48;
  EXPECT_EQ(FindCameraMotion(nothing, {}).kind, CameraMotionKind::kUnknown);
  scene.points = 3000;
  scene.frames = 2;  // no motion can be told from a flicker
  EXPECT_EQ(FindCameraMotion(TracksOf(scene), UnknownFocal(scene)).kind, CameraMotionKind::kStill);
}

TEST(CameraMotion, ACutLeavesNoPath) {
  SyntheticBackground scene;
  scene.pose = [](double t) { return Tremor(t, 2); };
  scene.frames_of_anchor = 45;
  BackgroundTracks tracks = TracksOf(scene);
  ASSERT_EQ(tracks.anchors.size(), 2u);
  tracks.anchors[0].sights.pop_back();
  tracks.anchors[1].after_break = true;
  const CameraMotion motion = FindCameraMotion(tracks, UnknownFocal(scene));
  EXPECT_EQ(motion.kind, CameraMotionKind::kMoving);
  EXPECT_FALSE(motion.has_path());
  EXPECT_NE(motion.why.find("lost 1 time"), std::string::npos) << motion.why;
}

TEST(CameraMotion, ContradictionsAreRefused) {
  SyntheticBackground scene;
  BackgroundTracks tracks = TracksOf(scene);
  tracks.anchors[0].sights[3].frame = scene.frames;
  EXPECT_THROW(FindCameraMotion(tracks, {}), std::invalid_argument);
  tracks = TracksOf(scene);
  tracks.anchors[0].sights[3].pixels.pop_back();
  EXPECT_THROW(FindCameraMotion(tracks, {}), std::invalid_argument);
  tracks = TracksOf(scene);
  tracks.anchors[0].points.pop_back();
  EXPECT_THROW(FindCameraMotion(tracks, {}), std::invalid_argument);
  tracks = TracksOf(scene);
  tracks.anchors.push_back(tracks.anchors[0]);
  EXPECT_THROW(FindCameraMotion(tracks, {}), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::camera_motion_test
