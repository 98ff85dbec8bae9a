// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/pose_landmarks.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>

namespace bodyloom::pose_landmarks_test {
namespace {

/// Outputs in which every landmark lies at (64, 128) of 256 and the heatmaps are cold.
struct Outputs {
  std::vector<float> landmarks = std::vector<float>(39 * 5, 0.0F);
  std::vector<float> heatmaps = std::vector<float>(64 * 64 * 39, -20.0F);
  std::vector<float> world = std::vector<float>(39 * 3, 0.0F);
  std::vector<float> mask;

  Outputs() {
    for (int k = 0; k < 39; ++k) {
      landmarks[size_t(k) * 5] = 64;
      landmarks[size_t(k) * 5 + 1] = 128;
    }
  }
  float& Heat(int column, int row, int k) { return heatmaps[(size_t(row) * 64 + column) * 39 + k]; }
  [[nodiscard]] DetectedPose Decoded(const PoseRegion& region) const {
    return DecodePose({landmarks, 0.75F, mask, heatmaps, world}, region, 640, 480);
  }
};

const PoseRegion kUpright{.centre = {300, 200}, .side = 200};
const PoseRegion kTurned{.centre = {300, 200}, .side = 200, .rotation = 0.7};

TEST(PoseLandmarks, PlacesDepthsAndVisibilityGoBackToTheImage) {
  Outputs outputs;
  outputs.landmarks[5 * 5 + 2] = -32;
  outputs.landmarks[5 * 5 + 3] = 1.5F;
  const DetectedPose pose = outputs.Decoded(kTurned);
  EXPECT_EQ(pose.presence, 0.75);
  EXPECT_TRUE(pose.landmarks[5].pixel.isApprox(kTurned.ImageFromFraction({0.25, 0.5}), 1e-12));
  EXPECT_DOUBLE_EQ(pose.landmarks[5].depth_px, -32.0 / 256 * 200);
  EXPECT_NEAR(pose.landmarks[5].visibility, 1 / (1 + std::exp(-1.5)), 1e-12);
  EXPECT_TRUE(pose.hips.isApprox(kTurned.ImageFromFraction({0.25, 0.5}), 1e-12));
  EXPECT_TRUE(pose.rim.isApprox(pose.hips, 1e-12));
  EXPECT_TRUE(pose.mask.labels.empty());
}

TEST(PoseLandmarks, MetresTurnWithTheRegionAndKeepTheirDepth) {
  Outputs outputs;
  outputs.world[3 * 7] = 0.3F, outputs.world[3 * 7 + 1] = -0.4F, outputs.world[3 * 7 + 2] = 0.11F;
  const Eigen::Vector3d w = outputs.Decoded(kTurned).landmarks[7].world;
  const double c = std::cos(0.7), s = std::sin(0.7);
  EXPECT_TRUE(w.isApprox(Eigen::Vector3d(0.3 * c + 0.4 * s, 0.3 * s - 0.4 * c, 0.11), 1e-6));
}

TEST(PoseLandmarks, HeatmapsMoveALandmarkToTheirCentreOfMass) {
  Outputs outputs;  // landmarks at cell (16, 32)
  outputs.Heat(18, 32, 3) = 5;
  outputs.Heat(18, 33, 3) = 5;
  outputs.Heat(20, 32, 3) = 9;  // four cells off: outside the window
  const PoseLandmark refined = outputs.Decoded(kUpright).landmarks[3];
  // Cold cells weigh 2e-9 each.
  EXPECT_TRUE(refined.pixel.isApprox(kUpright.ImageFromFraction({18.0 / 64, 32.5 / 64}), 1e-8));
  EXPECT_NEAR(refined.heat, 1 / (1 + std::exp(-5.0)), 1e-9);
  // Another landmark's heatmap is another one.
  EXPECT_TRUE(outputs.Decoded(kUpright).landmarks[4].pixel.isApprox(kUpright.ImageFromFraction({0.25, 0.5}), 1e-12));
}

TEST(PoseLandmarks, ColdHeatmapsAndPlacesOutsideThemChangeNothing) {
  Outputs outputs;
  outputs.Heat(17, 32, 0) = -0.01F;
  EXPECT_TRUE(outputs.Decoded(kUpright).landmarks[0].pixel.isApprox(kUpright.ImageFromFraction({0.25, 0.5}), 1e-12));
  EXPECT_NEAR(outputs.Decoded(kUpright).landmarks[0].heat, 0.4975, 1e-4);
  outputs.Heat(0, 32, 1) = 9;
  outputs.landmarks[5] = -5;  // a fifth of a cell to the left of the map
  EXPECT_TRUE(outputs.Decoded(kUpright).landmarks[1].pixel.isApprox(kUpright.ImageFromFraction({0.0, 0.5}), 0.02))
      << "trunc(-1.25) is outside";
  outputs.landmarks[5] = -2;
  EXPECT_NEAR(outputs.Decoded(kUpright).landmarks[1].pixel.x(), 200, 1e-4) << "trunc(-0.5) is cell 0";
  outputs.landmarks[5] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(outputs.Decoded(kUpright).landmarks[1].pixel.allFinite());
}

TEST(PoseLandmarks, WindowsAreCutAtTheBorder) {
  Outputs outputs;
  outputs.landmarks[5 * 2] = 255, outputs.landmarks[5 * 2 + 1] = 255;
  outputs.Heat(63, 62, 2) = 30;
  EXPECT_TRUE(
      outputs.Decoded(kUpright).landmarks[2].pixel.isApprox(kUpright.ImageFromFraction({63.0 / 64, 62.0 / 64}), 1e-7));
}

TEST(PoseLandmarks, MasksComeBackToTheImageAndStayInIt) {
  Outputs outputs;
  outputs.mask.assign(256 * 256, -9.0F);
  for (int row = 64; row < 192; ++row) {
    for (int column = 96; column < 160; ++column) outputs.mask[size_t(row) * 256 + column] = 9;
  }
  for (const PoseRegion& region : {kUpright, kTurned, PoseRegion{.centre = {2, 470}, .side = 150, .rotation = -2}}) {
    const LabelImage mask = outputs.Decoded(region).mask;
    ASSERT_FALSE(mask.labels.empty());
    EXPECT_GE(mask.x_begin, 0);
    EXPECT_GE(mask.y_begin, 0);
    EXPECT_LE(mask.x_begin + mask.width, 640);
    EXPECT_LE(mask.y_begin + mask.height, 480);
    int inside = 0;
    for (int y = 0; y < 480; ++y) {
      for (int x = 0; x < 640; ++x) {
        const Eigen::Vector2d f = region.FractionFromImage({double(x), double(y)}) * 256;
        // Half a cell about the rectangle's rim is left open.
        const double deep = std::min({f.x() - 95.5, 159.5 - f.x(), f.y() - 63.5, 191.5 - f.y()});
        if (std::abs(deep) < 0.51) continue;
        ASSERT_EQ(mask.At(x, y), deep > 0 ? 1 : 0) << x << ", " << y;
        inside += deep > 0 ? 1 : 0;
      }
    }
    EXPECT_GT(inside, 500);
  }
  // A region beside the image shows nothing of it.
  EXPECT_TRUE(outputs.Decoded({.centre = {-500, 0}, .side = 100}).mask.labels.empty());
}

/// The network's mask at a place of it, by the formula.
double ProbabilityAt(const std::vector<float>& logits, const Eigen::Vector2d& place) {
  const auto node = [&logits](int column, int row) {
    if (column < 0 || row < 0 || column >= 256 || row >= 256) return 0.0;
    return 1 / (1 + std::exp(-double(logits[size_t(row) * 256 + size_t(column)])));
  };
  const double x = std::clamp(place.x(), -1.0, 256.0), y = std::clamp(place.y(), -1.0, 256.0);
  const int x0 = int(std::floor(x)), y0 = int(std::floor(y));
  const double ax = x - x0, ay = y - y0;
  return (1 - ay) * ((1 - ax) * node(x0, y0) + ax * node(x0 + 1, y0)) +
         ay * ((1 - ax) * node(x0, y0 + 1) + ax * node(x0 + 1, y0 + 1));
}

TEST(PoseLandmarks, MasksOfAnyShapeFollowTheFormula) {
  Outputs outputs;
  outputs.mask.resize(256 * 256);
  std::mt19937 random(5);
  std::normal_distribution<float> noise;
  for (int i = 0; i < 256 * 256; ++i) {
    const int row = i / 256, column = i % 256;
    // Discs up to the border, a noisy quarter and pixels alone.
    const double disc = std::sin(column * 0.05) * std::cos(row * 0.031) * 6 + 1;
    outputs.mask[size_t(i)] = row < 128 && column < 128 ? noise(random) : i % 997 == 0 ? float(-disc) : float(disc);
  }
  for (const PoseRegion& region :
       {kUpright, kTurned, PoseRegion{.centre = {300, 250}, .side = 2000, .rotation = 0.3},
        PoseRegion{.centre = {300, 250}, .side = 90, .rotation = 1.5}, PoseRegion{.centre = {630, 5}, .side = 700}}) {
    const LabelImage mask = outputs.Decoded(region).mask;
    int undecided = 0;
    for (int y = mask.y_begin; y < mask.y_begin + mask.height; ++y) {
      for (int x = mask.x_begin; x < mask.x_begin + mask.width; ++x) {
        const double p = ProbabilityAt(outputs.mask, 256 * region.FractionFromImage({double(x), double(y)}));
        if (std::abs(p - 0.5) < 1e-4) {
          ++undecided;
        } else {
          ASSERT_EQ(mask.At(x, y), p > 0.5 ? 1 : 0) << x << ", " << y << ": " << p;
        }
      }
    }
    EXPECT_LT(undecided, mask.width * mask.height / 100);
  }
}

TEST(PoseLandmarks, OutputsOfAnotherNetworkAreRefused) {
  const Outputs outputs;
  const std::vector<float> few(7);
  EXPECT_THROW(DecodePose({few, 1, {}, outputs.heatmaps, outputs.world}, kUpright, 9, 9), std::invalid_argument);
  EXPECT_THROW(DecodePose({outputs.landmarks, 1, few, outputs.heatmaps, outputs.world}, kUpright, 9, 9),
               std::invalid_argument);
}

TEST(PoseLandmarks, DistanceIsRelativeToTheRegion) {
  const Outputs outputs;
  const DetectedPose a = outputs.Decoded(kUpright);
  DetectedPose b = a;
  for (PoseLandmark& landmark : b.landmarks) landmark.pixel.x() += 20;
  EXPECT_DOUBLE_EQ(PoseDistance(a, a), 0);
  EXPECT_NEAR(PoseDistance(a, b), 0.1, 1e-12);
}

}  // namespace
}  // namespace bodyloom::pose_landmarks_test
