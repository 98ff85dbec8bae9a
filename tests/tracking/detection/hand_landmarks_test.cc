// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/hand_landmarks.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/video/video_reader.h"
#include "geometry/base/hash_random.h"
#include "tests/support/paths.h"
#include "tests/tracking/detection/models_there.h"
#include "tracking/detection/face_landmarks.h"
#include "tracking/detection/model_files.h"

namespace bodyloom::hand_landmarks_test {
namespace {

namespace fs = std::filesystem;

constexpr int kTrials = 200;

Eigen::Vector2d RandomPoint(HashRandom* random) { return {1000 * random->Uniform(), 800 * random->Uniform()}; }

// MediaPipe's rules, step by step as its calculators do them.

double Wrapped(double angle) {
  const double turn = 2 * std::numbers::pi;
  return angle - turn * std::floor((angle + std::numbers::pi) / turn);
}

/// DetectionsToRectsCalculator's angle: the one by which start → end is turned into `target`.
double Rotation(const Eigen::Vector2d& start, const Eigen::Vector2d& end, double target_deg) {
  return Wrapped(target_deg * std::numbers::pi / 180 - std::atan2(-(end.y() - start.y()), end.x() - start.x()));
}

struct Rectangle {
  Eigen::Vector2d centre;
  double width, height, rotation;
};

/// RectTransformationCalculator with square_long.
PoseRegion Transformed(const Rectangle& rectangle, double shift_y, double scale) {
  const double up = rectangle.height * shift_y;
  return {.centre = {rectangle.centre.x() - up * std::sin(rectangle.rotation),
                     rectangle.centre.y() + up * std::cos(rectangle.rotation)},
          .side = scale * std::max(rectangle.width, rectangle.height),
          .rotation = rectangle.rotation};
}

void ExpectSame(const PoseRegion& region, const PoseRegion& expected) {
  EXPECT_LT((region.centre - expected.centre).norm(), 1e-9);
  EXPECT_NEAR(region.side, expected.side, 1e-9);
  EXPECT_NEAR(Wrapped(region.rotation - expected.rotation), 0, 1e-9);
}

TEST(HandRegions, OfTheBodyAreMediaPipes) {
  HashRandom random(1, {});
  for (int trial = 0; trial < kTrials; ++trial) {
    const Eigen::Vector2d wrist = RandomPoint(&random), little = RandomPoint(&random), index = RandomPoint(&random);
    const Eigen::Vector2d middle((2 * index.x() + little.x()) / 3, (2 * index.y() + little.y()) / 3);
    const double size = 2 * std::hypot(middle.x() - wrist.x(), middle.y() - wrist.y());
    ExpectSame(HandRegionOfBody(wrist, little, index),
               Transformed({middle, size, size, Rotation(wrist, middle, 90)}, -0.1, 2.7));
  }
  EXPECT_FALSE(HandRegionOfBody({5, 5}, {5, 5}, {5, 5}).IsValid());
}

TEST(HandRegions, OfAnAxisAreMediaPipes) {
  HashRandom random(2, {});
  for (int trial = 0; trial < kTrials; ++trial) {
    const Eigen::Vector2d middle = RandomPoint(&random), below = RandomPoint(&random);
    const double size = 2 * (below - middle).norm();
    ExpectSame(HandRegionOfAxis(middle, below),
               Transformed({middle, size, size, Rotation(middle, below, -90)}, -0.1, 1));
  }
}

TEST(HandRegions, OfPointsAreMediaPipes) {
  HashRandom random(3, {});
  for (int trial = 0; trial < kTrials; ++trial) {
    HandPixels points;
    for (Eigen::Vector2d& point : points) point = RandomPoint(&random);
    // HandLandmarksToRectCalculator, whose places 4, 6 and 8 are the index', the middle and the ring finger's first.
    const int kept[] = {0, 1, 2, 3, 5, 6, 9, 10, 13, 14, 17, 18};
    const auto at = [&](int k) { return points[size_t(kept[k])]; };
    const double rotation = Rotation(at(0), ((at(4) + at(8)) / 2 + at(6)) / 2, 90);
    Eigen::Array2d low(1e9, 1e9), high = -low, turned_low = low, turned_high = high;
    for (int k = 0; k < 12; ++k) low = low.min(at(k).array()), high = high.max(at(k).array());
    const Eigen::Vector2d upright = ((low + high) / 2).matrix();
    for (int k = 0; k < 12; ++k) {
      const Eigen::Vector2d p = at(k) - upright;
      const double c = std::cos(-rotation), s = std::sin(-rotation);
      const Eigen::Array2d q(p.x() * c - p.y() * s, p.x() * s + p.y() * c);
      turned_low = turned_low.min(q), turned_high = turned_high.max(q);
    }
    const Eigen::Vector2d middle = ((turned_low + turned_high) / 2).matrix();
    const Eigen::Vector2d centre(middle.x() * std::cos(rotation) - middle.y() * std::sin(rotation) + upright.x(),
                                 middle.x() * std::sin(rotation) + middle.y() * std::cos(rotation) + upright.y());
    const Eigen::Array2d size = turned_high - turned_low;
    ExpectSame(HandRegionOfPoints(points), Transformed({centre, size.x(), size.y(), rotation}, -0.1, 2));
  }
}

TEST(FaceRegions, LieAroundUprightRectangles) {
  HashRandom random(4, {});
  for (const size_t count : {size_t{11}, size_t{kFaceNetworkLandmarks}}) {
    std::vector<Eigen::Vector2d> points(count);
    double x0 = 1e9, x1 = -1e9, y0 = 1e9, y1 = -1e9;
    for (Eigen::Vector2d& p : points) {
      p = RandomPoint(&random);
      x0 = std::min(x0, p.x()), x1 = std::max(x1, p.x()), y0 = std::min(y0, p.y()), y1 = std::max(y1, p.y());
    }
    const bool body = count == 11;
    const double rotation = body ? Rotation(points[5], points[2], 0) : Rotation(points[33], points[263], 0);
    ExpectSame(body ? FaceRegionOfBody(points) : FaceRegionOfPoints(points),
               {.centre = {(x0 + x1) / 2, (y0 + y1) / 2},
                .side = (body ? 2 : 1.5) * std::max(x1 - x0, y1 - y0),
                .rotation = rotation});
    points.pop_back();
    EXPECT_THROW(body ? FaceRegionOfBody(points) : FaceRegionOfPoints(points), std::invalid_argument);
  }
}

TEST(HandLandmarks, PointsAreTurnedIntoTheImage) {
  std::vector<float> landmarks(63, 112), world(63, 0);
  landmarks[3] = 224, landmarks[4] = 0;  // the thumb's first point: the crop's upper right corner
  world[3] = 0.05F, world[4] = -0.02F, world[5] = 0.01F;
  const PoseRegion region{.centre = {300, 200}, .side = 100, .rotation = std::numbers::pi / 2};
  const DetectedHand hand = DecodeHand({.landmarks = landmarks, .presence = 0.75F, .world = world}, region);
  EXPECT_EQ(hand.presence, 0.75);
  EXPECT_LT((hand.points[0] - Eigen::Vector2d(300, 200)).norm(), 1e-9);
  EXPECT_LT((hand.points[1] - Eigen::Vector2d(350, 250)).norm(), 1e-9) << "a quarter turn clockwise";
  EXPECT_LT((hand.world[1] - Eigen::Vector3d(0.02, 0.05, 0.01)).norm(), 1e-6);
  landmarks.pop_back();
  EXPECT_THROW(DecodeHand({.landmarks = landmarks, .presence = 1, .world = world}, region), std::invalid_argument);
}

TEST(HandLandmarks, DeviationsGrowWithSizeFingertipsAndDisagreement) {
  DetectedHand first, last;
  last.presence = 0.9;
  last.region.side = 300;
  for (size_t k = 0; k < kHandPoints; ++k) last.points[k] = first.points[k] = Eigen::Vector2d(double(k), 2 * double(k));
  const HandObservation same = HandOf(first, last);
  const double of_level[] = {6, 8, 10, 13};  // percent of the hand's length, 100 pixels
  for (size_t k = 0; k < kHandPoints; ++k) {
    EXPECT_NEAR(same.sigma_px[k], std::hypot(k == 0 ? 6 : of_level[(k - 1) % 4], 0.8), 1e-5) << k;
    EXPECT_EQ(same.points[k].x, float(k));
    EXPECT_EQ(same.points[k].confidence, 0.9F);
  }
  for (Eigen::Vector2d& p : first.points) p.x() += 20;
  EXPECT_NEAR(HandOf(first, last).sigma_px[4], std::sqrt(13.0 * 13 + 16 * 16 + 0.8 * 0.8), 1e-4);
  last.region.side = 30, first = last;
  EXPECT_NEAR(HandOf(first, last).sigma_px[0], std::hypot(0.6, 0.8), 1e-6);
}

TEST(FaceLandmarks, TheSixtyEightOfTheNetworks) {
  std::vector<float> landmarks(3 * kFaceNetworkLandmarks);
  for (size_t k = 0; k < kFaceNetworkLandmarks; ++k) {
    landmarks[3 * k] = float(k % 192), landmarks[3 * k + 1] = float(k / 192), landmarks[3 * k + 2] = float(k) - 200;
  }
  const PoseRegion region{.centre = {96, 96}, .side = 192};
  const DetectedFace face = DecodeFace(landmarks, 0, region);
  EXPECT_EQ(face.presence, 0.5);
  const FaceObservation seen = FaceOf(face);
  for (size_t k = 0; k < kFacePoints; ++k) {
    const auto from = size_t(Face68Of468()[k]);
    EXPECT_NEAR(seen.points[k].x, float(from % 192), 1e-4);
    EXPECT_NEAR(seen.points[k].y, float(from / 192), 1e-4);
    EXPECT_NEAR(seen.depth_px[k], float(from) - 200, 1e-3);
  }
  EXPECT_NEAR(seen.sigma_px, std::hypot(1.92, 0.5), 1e-5);
  EXPECT_THROW(DecodeFace(std::span(landmarks).first(9), 0, region), std::invalid_argument);
}

/// A hand that signs, followed from where the reference found it first, against MediaPipe's own landmarks of every
/// frame.
TEST(HandLandmarks, FollowASigningHandAsTheReference) {
  const fs::path folder = fs::path(SharedDir()) / "data" / "tfjs_hands";
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there";
  if (!HandModelsAreThere()) GTEST_SKIP() << "no networks; ./dev models fetches them";
  const auto json = nlohmann::json::parse(ReadFileBytes((folder / "asl_hand.full.json").string()));
  const HandDetector detector("");
  VideoReader video((folder / "asl_hand.25fps.mp4").string());
  std::vector<double> distances;
  HandPixels last;
  Image frame;
  for (size_t t = 0; video.Read(&frame); ++t) {
    HandPixels expected;
    for (size_t k = 0; k < kHandPoints; ++k) {
      expected[k] = {json.at(t).at(k).at(0).get<double>(), json.at(t).at(k).at(1).get<double>()};
    }
    if (t == 0) last = expected;
    const DetectedHand hand = detector.HandIn(frame, HandRegionOfPoints(last));
    ASSERT_GE(hand.presence, 0.5) << "frame " << t;
    for (size_t k = 0; k < kHandPoints; ++k) distances.push_back((hand.points[k] - expected[k]).norm());
    last = hand.points;
  }
  ASSERT_EQ(distances.size(), 325U * kHandPoints);
  std::sort(distances.begin(), distances.end());
  // 0.19 and 2.3 px of 1080 when this was written.
  EXPECT_LT(distances[distances.size() / 2], 0.5);
  EXPECT_LT(distances[distances.size() * 99 / 100], 5);
}

}  // namespace
}  // namespace bodyloom::hand_landmarks_test
