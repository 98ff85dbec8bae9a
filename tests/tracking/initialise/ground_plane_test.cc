// SPDX-License-Identifier: Apache-2.0
// Vertical and ground from feet with known truth: tilted cameras, noise in depth, and clips without ground.
#include "tracking/initialise/ground_plane.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "geometry/math/rotation.h"

namespace bodyloom::ground_plane_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180, kAnkle = 0.08;

double AngleDeg(const Vector3d& a, const Vector3d& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0)) / kDegree;
}

/// Somebody steps about before a camera; every half second one foot is put somewhere else.
struct Walk {
  std::vector<std::array<FootPlace, 2>> feet;
  std::vector<double> timestamps;
  std::vector<std::array<Vector3d, 2>> truth_m;
  Vector3d up;  ///< true, camera axes
  double camera_height_m = 1.4;
};

struct WalkOptions {
  double elevation_deg = 10, roll_deg = 0;
  double depth_error = 0.02;  ///< relative depth error of each stance
  double step_up_m = 0;       ///< of every step
  double jitter_m = 0.005;
  int steps = 12;
  uint64_t seed = 1;
};

Walk MakeWalk(const WalkOptions& options) {
  std::mt19937_64 random(options.seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1, 1);
  Walk walk;
  // World: y up. The camera looks along −z, tilted down by the elevation.
  const Matrix3d level = (Matrix3d() << 1, 0, 0, 0, -1, 0, 0, 0, -1).finished();
  const Matrix3d camera_from_world = RotationFromAxisAngle(Vector3d(0, 0, options.roll_deg * kDegree)) *
                                     RotationFromAxisAngle(Vector3d(options.elevation_deg * kDegree, 0, 0)) * level;
  walk.up = camera_from_world.col(1);
  const Vector3d camera(0, walk.camera_height_m, 4);
  std::array<Vector3d, 2> place = {Vector3d(-0.1, kAnkle, 0), Vector3d(0.1, kAnkle, 0)};
  std::array<double, 2> scale = {1, 1};
  for (int step = 0; step < options.steps; ++step) {
    const int moving = step % 2;
    place[moving] =
        Vector3d{0.8 * uniform(random) + 0.2 * moving, kAnkle + step * options.step_up_m, 1.2 * uniform(random)};
    scale[moving] = 1 + options.depth_error * normal(random);
    for (int i = 0; i < 8; ++i) {
      auto& both = walk.feet.emplace_back();
      auto& truth = walk.truth_m.emplace_back();
      for (int foot = 0; foot < 2; ++foot) {
        const bool swings = foot == moving && i < 3;
        truth[foot] = camera_from_world * (place[foot] - camera);
        both[foot].contact = swings ? 0.05 : 0.8;
        both[foot].seen = true;
        both[foot].ankle_m = scale[foot] * truth[foot] + options.jitter_m * Vector3d{normal(random), normal(random), 0};
        if (swings) both[foot].ankle_m += 0.2 * Vector3d{normal(random), normal(random), 0};
      }
      walk.timestamps.push_back(static_cast<double>(walk.timestamps.size()) / 15);
    }
  }
  return walk;
}

TEST(GroundPlane, FindsTheKnownPlaneFromTiltedCameras) {
  for (const double elevation : {-8.0, 0.0, 10.0, 25.0, 40.0}) {
    for (const double roll : {-6.0, 0.0, 12.0}) {
      WalkOptions options;
      options.elevation_deg = elevation;
      options.roll_deg = roll;
      const Walk walk = MakeWalk(options);
      // The lifter's up is a few degrees off.
      const Vector3d lifter_up = RotationFromAxisAngle(Vector3d(0.03, 0, -0.02)) * walk.up;
      const GroundPlane ground = EstimateGroundPlane(walk.feet, walk.timestamps, lifter_up, {});
      ASSERT_TRUE(ground.found) << elevation << " " << roll << ": " << ground.why;
      EXPECT_LT(AngleDeg(ground.normal, walk.up), 2.5) << elevation << " " << roll;
      EXPECT_NEAR(kAnkle - ground.offset_m, walk.camera_height_m, 0.12) << elevation << " " << roll;
      EXPECT_LT(ground.spread_m, 0.05);
      EXPECT_GE(ground.share, 0.9);
    }
  }
}

TEST(GroundPlane, FeetOverruleAnUpThatIsOff) {
  WalkOptions options;
  options.depth_error = 0.002;
  options.steps = 30;
  const Walk walk = MakeWalk(options);
  const Vector3d lifter_up = RotationFromAxisAngle(Vector3d(0.07, 0, 0.05)) * walk.up;
  const GroundPlane ground = EstimateGroundPlane(walk.feet, walk.timestamps, lifter_up, {});
  ASSERT_TRUE(ground.found) << ground.why;
  EXPECT_GT(AngleDeg(lifter_up, walk.up), 4.5);
  EXPECT_LT(AngleDeg(ground.normal, walk.up), 2);
}

TEST(GroundPlane, ItsStandardDeviationsAreThoseOfItsErrors) {
  // Depth and vertical err as the options say that they do.
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  double up_sq = 0, up_var = 0, height_sq = 0, height_var = 0;
  int count = 0;
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    WalkOptions options;
    options.seed = seed;
    options.depth_error = 0.03;
    options.elevation_deg = 20;
    const Walk walk = MakeWalk(options);
    const double s = GroundPlaneOptions().up_rad;
    const Vector3d lifter_up = RotationFromAxisAngle(Vector3d{s * normal(random), 0, s * normal(random)}) * walk.up;
    const GroundPlane ground = EstimateGroundPlane(walk.feet, walk.timestamps, lifter_up, {});
    if (!ground.found) continue;
    ++count;
    up_sq += std::pow(AngleDeg(ground.normal, walk.up) * kDegree, 2);
    up_var += std::pow(ground.up_sigma_rad, 2);
    height_sq += std::pow(kAnkle - ground.offset_m - walk.camera_height_m, 2);
    height_var += std::pow(ground.offset_sigma_m, 2);
  }
  ASSERT_GT(count, 50);
  EXPECT_LT(up_sq, 4 * up_var);
  EXPECT_GT(up_sq, up_var / 4);
  EXPECT_LT(up_var / count, 2 * std::pow(GroundPlaneOptions().up_rad, 2)) << "feet tell more than the lifter alone";
  RecordProperty("height_rms_m", std::to_string(std::sqrt(height_sq / count)));
  RecordProperty("height_sigma_m", std::to_string(std::sqrt(height_var / count)));
}

TEST(GroundPlane, TheGroundTellsTheDepthOfAStance) {
  WalkOptions options;
  options.elevation_deg = 25;
  options.depth_error = 0.03;
  options.steps = 24;
  double before = 0, after = 0;
  for (options.seed = 1; options.seed <= 20; ++options.seed) {
    const Walk walk = MakeWalk(options);
    const GroundPlane ground = EstimateGroundPlane(walk.feet, walk.timestamps, walk.up, {});
    ASSERT_TRUE(ground.found) << ground.why;
    for (const Stance& stance : ground.stances) {
      const Vector3d& truth = walk.truth_m[stance.begin][stance.foot];
      before += (walk.feet[stance.begin][stance.foot].ankle_m - truth).squaredNorm();
      after += (stance.place_m - truth).squaredNorm();
    }
  }
  RecordProperty("share_left", std::to_string(after / before));
  EXPECT_LT(after, 0.4 * before);
}

TEST(GroundPlane, FeetStandOnAPlaneThatIsGiven) {
  WalkOptions options;
  options.depth_error = 0.03;
  const Walk walk = MakeWalk(options);
  const GroundPlane given = StandOnPlane(walk.feet, walk.timestamps, walk.up, kAnkle - walk.camera_height_m, {});
  ASSERT_TRUE(given.found) << given.why;
  EXPECT_EQ(given.normal, walk.up);
  EXPECT_EQ(given.offset_m, kAnkle - walk.camera_height_m);
  double before = 0, after = 0;
  for (const Stance& stance : given.stances) {
    const Vector3d& truth = walk.truth_m[stance.begin][stance.foot];
    before += std::abs(walk.up.dot(walk.feet[stance.begin][stance.foot].ankle_m - truth));
    after += std::abs(walk.up.dot(stance.place_m - truth));
  }
  EXPECT_LT(after, before);
  // Half a metre higher nobody stands.
  EXPECT_FALSE(StandOnPlane(walk.feet, walk.timestamps, walk.up, kAnkle - walk.camera_height_m + 0.5, {}).found);
}

TEST(GroundPlane, StancesBeginAndEndWithTheFoot) {
  WalkOptions options;
  options.depth_error = options.jitter_m = 0;
  const Walk walk = MakeWalk(options);
  const GroundPlane ground = EstimateGroundPlane(walk.feet, walk.timestamps, walk.up, {});
  ASSERT_TRUE(ground.found);
  for (const Stance& stance : ground.stances) {
    EXPECT_GE(stance.seconds, 0.1);
    for (int t = stance.begin; t < stance.end; ++t) {
      EXPECT_GT(walk.feet[t][stance.foot].contact, 0.5);
      EXPECT_LT((walk.truth_m[t][stance.foot] - stance.place_m).norm(), 0.01) << "one place, not two";
    }
  }
}

TEST(GroundPlane, NoGroundIsSaid) {
  const Walk walk = MakeWalk({});
  Walk jumps = walk, legless = walk, slides = walk, broken = walk;
  for (auto& both : jumps.feet) both[0].contact = both[1].contact = 0.1;
  for (auto& both : legless.feet) both[0].seen = both[1].seen = false;
  for (size_t t = 0; t < slides.feet.size(); ++t) {
    for (auto& foot : slides.feet[t]) foot.ankle_m.x() += 1.0 * slides.timestamps[t];
  }
  for (auto& both : broken.feet) both[0].ankle_m.x() = both[1].contact = std::numeric_limits<double>::quiet_NaN();
  for (const Walk* clip : {&jumps, &legless, &slides, &broken}) {
    const GroundPlane ground = EstimateGroundPlane(clip->feet, clip->timestamps, clip->up, {});
    EXPECT_FALSE(ground.found);
    EXPECT_TRUE(ground.stances.empty());
    EXPECT_FALSE(ground.why.empty());
  }
  EXPECT_FALSE(EstimateGroundPlane({}, {}, walk.up, {}).found);
  EXPECT_THROW(EstimateGroundPlane(walk.feet, std::vector<double>(3, 0), walk.up, {}), std::invalid_argument);
}

TEST(GroundPlane, StairsAreNoGround) {
  WalkOptions options;
  options.step_up_m = 0.17;
  const Walk walk = MakeWalk(options);
  const GroundPlane ground = EstimateGroundPlane(walk.feet, walk.timestamps, walk.up, {});
  EXPECT_FALSE(ground.found);
  EXPECT_TRUE(ground.stances.empty());
}

std::vector<LiftedFrame> Ups(int count, double noise_rad, double wrong_share, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  std::vector<LiftedFrame> frames(count);
  for (LiftedFrame& frame : frames) {
    frame.seen = true;
    frame.up_sigma = 0.1;
    const double size = uniform(random) < wrong_share ? 1.5 : noise_rad;
    frame.up = RotationFromAxisAngle(Vector3d{size * normal(random), size * normal(random), size * normal(random)}) *
               Vector3d(0.1, -0.9, -0.3).normalized();
  }
  return frames;
}

TEST(EstimateUp, OneDirectionOfManyFrames) {
  const Vector3d truth = Vector3d(0.1, -0.9, -0.3);
  for (const double wrong : {0.0, 0.25}) {
    const UpEstimate up = EstimateUp(Ups(200, 0.08, wrong, 5));
    ASSERT_TRUE(up.found) << wrong;
    EXPECT_LT(AngleDeg(up.up, truth), 2) << wrong;
    EXPECT_NEAR(up.up.norm(), 1, 1e-12);
  }
  EXPECT_FALSE(EstimateUp(Ups(200, 1.5, 0, 6)).found) << "any direction is as good as another";
  EXPECT_FALSE(EstimateUp({}).found);
  auto unseen = Ups(20, 0, 0, 7);
  for (LiftedFrame& frame : unseen) frame.seen = false;
  EXPECT_FALSE(EstimateUp(unseen).found);
  auto broken = Ups(20, 0.01, 0, 8);
  broken[3].up.x() = std::numeric_limits<double>::quiet_NaN();
  broken[4].up_sigma = 0;
  EXPECT_LT(AngleDeg(EstimateUp(broken).up, truth), 2);
}

TEST(GroundPlane, IsTheSameFromACameraThatIsElsewhereInTheScene) {
  const Walk walk = MakeWalk({});
  const GroundPlane from_origin = EstimateGroundPlane(walk.feet, walk.timestamps, walk.up, {});
  ASSERT_TRUE(from_origin.found) << from_origin.why;
  const Vector3d elsewhere(3, -1, 2);
  Walk moved = walk;
  for (auto& both : moved.feet) {
    for (FootPlace& foot : both) {
      foot.ankle_m += elsewhere;
      foot.camera_m = elsewhere;
    }
  }
  const GroundPlane found = EstimateGroundPlane(moved.feet, moved.timestamps, moved.up, {});
  ASSERT_TRUE(found.found) << found.why;
  EXPECT_EQ(found.stances.size(), from_origin.stances.size());
  // The plane's tilt and offset are one estimate about the origin, so its prior on the tilt pulls from another place.
  EXPECT_LT(AngleDeg(found.normal, from_origin.normal), 0.5);
  EXPECT_NEAR(found.offset_m - found.normal.dot(elsewhere), from_origin.offset_m, 0.02);
}

TEST(GroundPlane, StandingFeetGoWithACameraThatIsSaidToStandStill) {
  Walk walk = MakeWalk({.jitter_m = 0});
  EXPECT_LT(StandingSpeed(walk.feet, walk.timestamps, {}), 1e-9);
  for (size_t t = 0; t < walk.feet.size(); ++t) {
    for (FootPlace& foot : walk.feet[t]) foot.ankle_m += walk.timestamps[t] * Vector3d(0.8, 0, 0);
  }
  const double speed = StandingSpeed(walk.feet, walk.timestamps, {});
  EXPECT_GT(speed, 0.6);
  EXPECT_LT(speed, 0.8) << "the part along the view does not show";
  for (auto& both : walk.feet) both[0].seen = both[1].seen = false;
  EXPECT_TRUE(std::isnan(StandingSpeed(walk.feet, walk.timestamps, {})));
}

/// Errors along the views' axes are what the views have in common; their own ones leave the stated σ.
TEST(JoinUps, IsTheTrueVerticalWithinItsStandardDeviation) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const Vector3d truth = Vector3d(0.05, -1, 0.1).normalized();
  for (const int num_views : {1, 2, 4}) {
    double squares = 0, stated = 0;
    constexpr int kTrials = 2000;
    for (int trial = 0; trial < kTrials; ++trial) {
      const double along = kUpAlongRad * normal(random);
      std::vector<UpOfView> views;
      for (int v = 0; v < num_views; ++v) {
        const double heading = 1.2 * v;
        const Vector3d axis = (Vector3d(std::sin(heading), 0, std::cos(heading)) + 0.1 * truth).normalized();
        const Vector3d error{normal(random), normal(random), normal(random)};
        views.push_back({(truth + along * axis + kUpAcrossRad * error).normalized(), axis});
      }
      const JoinedUps joined = JoinUps(views);
      squares += joined.up.cross(truth).squaredNorm() / 2 / kTrials;
      stated += joined.sigma_rad * joined.sigma_rad / kTrials;
    }
    EXPECT_NEAR(std::sqrt(squares / stated), 1, 0.05) << num_views << " views";
  }
}

TEST(JoinUps, AViewByItselfSaysWhatItSays) {
  const Vector3d up = Vector3d(0.1, -1, 0.3).normalized();
  EXPECT_LT((JoinUps(std::vector<UpOfView>{{up, Vector3d::UnitZ()}}).up - up).norm(), 1e-12);
}

}  // namespace
}  // namespace bodyloom::ground_plane_test
