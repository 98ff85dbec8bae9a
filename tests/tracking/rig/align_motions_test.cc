// SPDX-License-Identifier: Apache-2.0
// Motions of known truth, as two cameras with known poses and clocks see them.
#include "tracking/rig/align_motions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "geometry/base/hash_random.h"
#include "geometry/math/procrustes.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"

namespace bodyloom::align_motions_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::HasSubstr;

constexpr int kPoints = 12, kLimbs = 6;
constexpr double kFine_s = 1.0 / 240;

/// Shoulders, elbows, wrists, hips, knees and ankles of somebody who dances: every limb swings by up to 0.25 m in each
/// direction in three waves of 0.15 to 1 Hz, while the body turns and moves about.
class Dance {
 public:
  /// `speed` multiplies all frequencies; 0: stands still.
  explicit Dance(uint64_t seed, double speed = 1) : speed_(speed) {
    HashRandom random(seed, {1});
    for (auto& of_limb : waves_) {
      for (auto& of_axis : of_limb) {
        for (Wave& wave : of_axis) wave = DrawWave(0.2, &random);
      }
    }
    for (auto& of_axis : path_) {
      for (Wave& wave : of_axis) wave = DrawWave(0.4, &random);
    }
    turn_ = DrawWave(1.2, &random);
  }

  /// The same motion again after each of these seconds: frequencies are multiples of its inverse.
  Dance& Repeat(double period_s) {
    const auto tune = [&](Wave* wave) {
      wave->frequency = std::max(1.0, std::round(wave->frequency * period_s)) / period_s;
    };
    for (auto& of_limb : waves_) {
      for (auto& of_axis : of_limb) {
        for (Wave& wave : of_axis) tune(&wave);
      }
    }
    for (auto& of_axis : path_) {
      for (Wave& wave : of_axis) tune(&wave);
    }
    tune(&turn_);
    return *this;
  }

  /// In the world, y up; 12×3 metres.
  [[nodiscard]] MatrixX3d At(double t) const {
    constexpr double kRest[kLimbs][2] = {{0.18, 1.45}, {0.3, 1.15}, {0.35, 0.9}, {0.1, 0.95}, {0.12, 0.5}, {0.12, 0.1}};
    const Matrix3d turn = RotationFromAxisAngle({0, turn_.At(speed_ * t), 0});
    const Vector3d place(Sum(path_[0], t), 0, Sum(path_[1], t));
    MatrixX3d points(kPoints, 3);
    for (int k = 0; k < kPoints; ++k) {
      const int joint = k / 2, limb = (joint < 3 ? 0 : 2) + k % 2;  // arms and legs swing as a whole, ends the most
      const double share = joint % 3 == 0 ? 0.15 : joint % 3 == 1 ? 0.6 : 1;
      Vector3d p((k % 2 == 0 ? 1 : -1) * kRest[joint][0], kRest[joint][1], 0);
      for (int axis = 0; axis < 3; ++axis) p[axis] += share * Sum(waves_[limb][axis], t);
      points.row(k) = (turn * p + place).transpose();
    }
    return points;
  }

 private:
  struct Wave {
    double size = 0, frequency = 0, phase = 0;
    [[nodiscard]] double At(double t) const { return size * std::sin(2 * M_PI * frequency * t + phase); }
  };
  using Waves = std::array<Wave, 3>;
  static Wave DrawWave(double size, HashRandom* random) {
    return {random->Uniform(0.5 * size, size), random->Uniform(0.15, 1), random->Uniform(0, 2 * M_PI)};
  }
  [[nodiscard]] double Sum(const Waves& waves, double t) const {
    double sum = 0;
    for (const Wave& wave : waves) sum += wave.At(speed_ * t);
    return sum;
  }
  double speed_;
  std::array<std::array<Waves, 3>, 4> waves_;
  std::array<Waves, 2> path_;
  Wave turn_;
};

/// A camera whose clock shows t + offset_s at time t.
struct Recording {
  double begin_s = 0, length_s = 8, fps = 30, offset_s = 0;  ///< begin: by the true clock
  int drop_every = 0;                                        ///< every nth frame is missing
  double noise_m = 0;  ///< σ along the optical axis of errors that last for a third of a second; across it a third
  CameraPose camera = {};
};

CameraPose CameraAround(double yaw_deg, double distance_m = 4, double tilt = 0.1) {
  CameraPose pose;
  pose.camera_from_world_rotation = RotationFromAxisAngle({tilt, 0, 0}) * RotationFromAxisAngle({M_PI, 0, 0}) *
                                    RotationFromAxisAngle({0, yaw_deg * M_PI / 180, 0});
  pose.camera_from_world_translation =
      Vector3d(0, 0, distance_m) - pose.camera_from_world_rotation * Vector3d(0, 0.9, 0);
  return pose;
}

ViewMotion Record(const Dance& dance, const Recording& how, uint64_t seed = 1) {
  ViewMotion motion;
  HashRandom random(seed, {2});
  std::array<Vector3d, kLimbs> error;
  const auto draw = [&] { return Vector3d{random.Normal(), random.Normal(), random.Normal()}; };
  for (Vector3d& e : error) e = draw();
  const double keep = std::exp(-3 / how.fps), fresh = std::sqrt(1 - keep * keep);
  const int frames = static_cast<int>(std::lround(how.length_s * how.fps));
  for (int i = 0; i < frames; ++i) {
    for (Vector3d& e : error) e = keep * e + fresh * draw();
    if (how.drop_every > 0 && i % how.drop_every == how.drop_every - 1) continue;
    const double t = how.begin_s + i / how.fps;
    motion.timestamps.push_back(t + how.offset_s);
    MatrixX3d points = MovedPoints(how.camera, dance.At(t));
    for (int k = 0; k < kPoints; ++k) {
      const int limb = k % 2 + 2 * (k < 4 ? 0 : k < 8 ? 1 : 2);
      points.row(k) += how.noise_m * error[limb].cwiseProduct(Vector3d(1.0 / 3, 1.0 / 3, 1)).transpose();
    }
    motion.points.push_back(std::move(points));
  }
  return motion;
}

CameraPose TrueBFromA(const Recording& a, const Recording& b) { return Compose(b.camera, Inverse(a.camera)); }

double RotationError(const MotionAlignment& found, const Recording& a, const Recording& b) {
  return RotationAngleBetween(found.b_from_a.camera_from_world_rotation, TrueBFromA(a, b).camera_from_world_rotation);
}

/// Of where b's camera places a's person, metres.
double PlaceError(const MotionAlignment& found, const Recording& a, const Recording& b) {
  const Vector3d there(0, 0, 4);
  return (MovedPoint(found.b_from_a, there) - MovedPoint(TrueBFromA(a, b), there)).norm();
}

void ExpectExact(const MotionAlignment& found, const Recording& a, const Recording& b) {
  ASSERT_TRUE(found.found) << found.why;
  EXPECT_TRUE(found.why.empty());
  EXPECT_NEAR(found.offset_s, b.offset_s - a.offset_s, kFine_s);
  EXPECT_LE(RotationError(found, a, b), 1e-3);
  EXPECT_LE(PlaceError(found, a, b), 5e-3);
  EXPECT_LE(found.distance_m, 0.01);
  EXPECT_GE(found.other_distance_m, 0.15);
  EXPECT_LE(found.offset_sigma_s, 0.005);
  EXPECT_GT(found.score, 0);
}

TEST(AlignMotions, ExactMotionsGiveRotationPlaceAndOffset) {
  for (const double offset : {0.0, 0.62, -3.1234, 1000.017}) {
    for (const double yaw : {60.0, -90.0, 175.0}) {
      const Recording a{.camera = CameraAround(10)},
          b{.begin_s = 0.8 + 0.11 * yaw / 60, .offset_s = offset, .camera = CameraAround(10 + yaw, 5, -0.2)};
      const MotionAlignment found = AlignMotions(Record(Dance(1), a), Record(Dance(1), b));
      ExpectExact(found, a, b);
      EXPECT_NEAR(found.overlap_s, 8 - std::abs(b.begin_s), 0.15);
    }
  }
}

/// The header's formulas as plain loops, at the offsets of the grid.
struct SlowTwin {
  std::vector<double> squared;  ///< d of every offset at which enough is seen by both
  double best_offset_s = 0, other_squared = 0, best_squared = 0, best_score = -1;

  SlowTwin(const ViewMotion& a, const ViewMotion& b, double step_s) {
    std::vector<std::pair<double, int>> tried;  // d and n
    std::vector<double> offsets;
    const int count_a = static_cast<int>(a.points.size()), count_b = static_cast<int>(b.points.size());
    for (int lag = 1 - count_a; lag < count_b; ++lag) {
      MatrixX3d x(0, 3), y(0, 3);
      for (int i = 0; i < count_a; ++i) {
        if (i + lag < 0 || i + lag >= count_b) continue;
        const MatrixX3d &p = a.points[i], &q = b.points[i + lag];
        x.conservativeResize(x.rows() + kPoints, 3);
        y.conservativeResize(y.rows() + kPoints, 3);
        x.bottomRows(kPoints) = p.rowwise() - p.colwise().mean();
        y.bottomRows(kPoints) = q.rowwise() - q.colwise().mean();
      }
      const int n = static_cast<int>(x.rows()) / kPoints;
      if (n < std::min<int>({15, count_a / 3, count_b / 3})) continue;
      const SimilarityTransform fit = AlignPoints(x, y, {.estimate_scale = false}).target_from_source;
      tried.emplace_back((x * fit.rotation.transpose() - y).squaredNorm() / static_cast<double>(x.rows()), n);
      offsets.push_back(b.timestamps[0] - a.timestamps[0] + lag * step_s);
      squared.push_back(tried.back().first);
    }
    std::sort(squared.begin(), squared.end());
    other_squared = std::max(squared[squared.size() / 2], 0.15 * 0.15);
    double best = 0;
    for (size_t i = 0; i < tried.size(); ++i) {
      const double likelihood = tried[i].second * std::log(other_squared / std::max(tried[i].first, 9e-4));
      if (likelihood <= best) continue;
      best = likelihood;
      best_score = tried[i].second * step_s * (other_squared - tried[i].first);
      best_squared = tried[i].first;
      best_offset_s = offsets[i];
    }
  }
};

TEST(AlignMotions, IsTheBestOfTheFormula) {
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    const Recording a{.length_s = 5, .fps = 15, .noise_m = 0.05, .camera = CameraAround(0)},
        b{.begin_s = 0.4, .length_s = 4, .fps = 15, .offset_s = 7, .noise_m = 0.05, .camera = CameraAround(80)};
    const ViewMotion of_a = Record(Dance(seed), a, 1), of_b = Record(Dance(seed), b, 2);
    const MotionAlignment found = AlignMotions(of_a, of_b);
    const SlowTwin twin(of_a, of_b, 1.0 / 15);
    ASSERT_TRUE(found.found) << found.why;
    EXPECT_NEAR(found.other_distance_m, std::sqrt(twin.other_squared), 1e-9);
    EXPECT_NEAR(found.score, twin.best_score, 1e-9);
    EXPECT_NEAR(found.offset_s, twin.best_offset_s, 1.0 / 15 + 1e-9);
    EXPECT_LE(found.distance_m, std::sqrt(twin.best_squared) + 1e-9);
  }
}

TEST(AlignMotions, FrameRatesDiffer) {
  for (const bool swap : {false, true}) {
    Recording a{.fps = 60, .camera = CameraAround(0)},
        b{.begin_s = 1.003, .fps = 25, .offset_s = 0.4137, .camera = CameraAround(70)};
    if (swap) std::swap(a, b);
    ExpectExact(AlignMotions(Record(Dance(3), a), Record(Dance(3), b)), a, b);
  }
}

TEST(AlignMotions, FramesAreMissing) {
  const Recording a{.fps = 25, .camera = CameraAround(0)},
      b{.begin_s = 0.0311, .fps = 25, .offset_s = -0.271, .drop_every = 7, .camera = CameraAround(-50)};
  ExpectExact(AlignMotions(Record(Dance(4), a), Record(Dance(4), b)), a, b);
}

TEST(AlignMotions, FramesAreNotKnown) {
  const Recording a{.length_s = 10, .camera = CameraAround(0)},
      b{.length_s = 10, .offset_s = 0.123, .camera = CameraAround(120)};
  ViewMotion of_a = Record(Dance(5), a), of_b = Record(Dance(5), b);
  const MotionAlignment all = AlignMotions(of_a, of_b);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int i = 60; i < 120; ++i) of_a.points[i].setConstant(nan);
  for (int i = 0; i < 45; ++i) of_b.points[i](3, 1) = nan;
  for (int i = 200; i < 300; i += 10) of_b.points[i].setConstant(nan);
  const MotionAlignment found = AlignMotions(of_a, of_b);
  ExpectExact(found, a, b);
  EXPECT_LT(found.overlap_s, all.overlap_s - 3.4);
  EXPECT_GT(found.overlap_s, 3);
}

TEST(AlignMotions, TheOverlapIsShort) {
  for (const double begin : {2.8, -2.8}) {
    const Recording a{.length_s = 6, .camera = CameraAround(0)},
        b{.begin_s = begin, .length_s = 6, .offset_s = 2.017, .camera = CameraAround(90)};
    const MotionAlignment found = AlignMotions(Record(Dance(6), a), Record(Dance(6), b));
    ExpectExact(found, a, b);
    EXPECT_NEAR(found.overlap_s, 3.2, 0.15);
  }
}

/// A fifth of two clips of 15 s, with the errors of monocular tracks.
TEST(AlignMotions, AFifthOfTheClipsInCommon) {
  int right = 0;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const Recording a{.length_s = 15, .noise_m = 0.06, .camera = CameraAround(0)},
        b{.begin_s = 12, .length_s = 15, .offset_s = 1.3, .noise_m = 0.06, .camera = CameraAround(70)};
    const MotionAlignment found = AlignMotions(Record(Dance(seed), a, seed), Record(Dance(seed), b, 100 + seed));
    right += found.found && std::abs(found.offset_s - 1.3) < 0.1 ? 1 : 0;
  }
  EXPECT_GE(right, 18);
}

/// Every three seconds; the clips have a third in common, and a period later they agree for longer.
TEST(AlignMotions, WhoRepeatsTheMotionHasSeveralClocks) {
  const Recording a{.length_s = 9, .noise_m = 0.03, .camera = CameraAround(0)},
      b{.begin_s = 6, .length_s = 9, .noise_m = 0.03, .camera = CameraAround(70)};
  const Dance repeats = Dance(3).Repeat(3);
  const MotionAlignment found = AlignMotions(Record(repeats, a), Record(repeats, b, 2));
  ASSERT_TRUE(found.found) << found.why;
  ASSERT_TRUE(std::isfinite(found.repeat_s));
  EXPECT_NEAR(std::remainder(found.offset_s, 3), 0, 0.1);
  EXPECT_NEAR(std::remainder(found.repeat_s, 3), 0, 0.1);
  EXPECT_GE(std::abs(found.repeat_s), 2.9);
  EXPECT_TRUE(std::isnan(AlignMotions(Record(Dance(3), a), Record(Dance(3), b, 2)).repeat_s));
}

TEST(AlignMotions, ErrorsOfSingleCamerasLeaveThreeDegrees) {
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    const Recording a{.length_s = 20, .noise_m = 0.06, .camera = CameraAround(0)},
        b{.length_s = 20,
          .fps = 25,
          .offset_s = 0.62,
          .noise_m = 0.06,
          .camera = CameraAround(40.0 * static_cast<double>(seed))};
    const MotionAlignment found = AlignMotions(Record(Dance(seed), a, seed), Record(Dance(seed), b, seed + 100));
    ASSERT_TRUE(found.found) << found.why;
    EXPECT_LE(RotationError(found, a, b) * 180 / M_PI, 3) << seed;
    EXPECT_NEAR(found.offset_s, 0.62, 0.04) << seed;
    EXPECT_LE(PlaceError(found, a, b), 0.1) << seed;
  }
}

/// Nothing tells the clocks apart then: the deviation is seconds.
TEST(AlignMotions, WhoStandsStillHasNoClock) {
  for (const double noise : {0.0, 0.02, 0.06}) {
    for (uint64_t seed = 1; seed <= 8; ++seed) {
      const Recording a{.length_s = 10, .noise_m = noise, .camera = CameraAround(0)},
          b{.length_s = 8, .offset_s = 0.5, .noise_m = noise, .camera = CameraAround(60)};
      const MotionAlignment found = AlignMotions(Record(Dance(7, 0), a, seed), Record(Dance(7, 0), b, seed + 50));
      ASSERT_TRUE(found.found) << found.why;
      EXPECT_GE(found.offset_sigma_s, 1) << noise << " m, " << seed;
      EXPECT_LE(found.offset_sigma_s, 10);
      EXPECT_LE(RotationError(found, a, b) * 180 / M_PI, 5);
    }
  }
}

struct Coverage {
  int cases = 0, in_one = 0, in_two = 0, not_found = 0;
};

TEST(AlignMotions, TheOffsetsDeviationIsHonest) {
  HashRandom random(11, {3});
  Coverage coverage;
  for (uint64_t seed = 0; seed < 60; ++seed) {
    const double length = random.Uniform(4, 20), speed = random.Uniform(0.3, 1.2), noise = random.Uniform(0.03, 0.08);
    Recording a{.length_s = length, .noise_m = noise, .camera = CameraAround(0)};
    Recording b = a;
    b.begin_s = random.Uniform(-0.3, 0.3) * length;
    b.offset_s = random.Uniform(-2, 2);
    b.fps = random.Uniform() < 0.5 ? 25 : 60;
    b.camera = CameraAround(random.Uniform(20, 180));
    const Dance dance(seed, speed);
    const MotionAlignment found = AlignMotions(Record(dance, a, 2 * seed), Record(dance, b, 2 * seed + 1));
    ++coverage.cases;
    if (!found.found) {
      ++coverage.not_found;
      continue;
    }
    const double error = std::abs(found.offset_s - b.offset_s);
    coverage.in_one += error < found.offset_sigma_s ? 1 : 0;
    coverage.in_two += error < 2 * found.offset_sigma_s ? 1 : 0;
  }
  EXPECT_EQ(coverage.not_found, 0);
  EXPECT_GE(coverage.in_one, 0.5 * coverage.cases);
  EXPECT_LE(coverage.in_one, 0.85 * coverage.cases);
  EXPECT_GE(coverage.in_two, 0.85 * coverage.cases);
}

TEST(AlignMotions, DifferentMotionsAreRefused) {
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    const Recording a{.length_s = 12, .camera = CameraAround(0)}, b{.length_s = 12, .camera = CameraAround(60)};
    const MotionAlignment found = AlignMotions(Record(Dance(seed), a), Record(Dance(seed + 20), b));
    EXPECT_FALSE(found.found) << seed << ": " << found.distance_m;
    EXPECT_THAT(found.why, HasSubstr("the motions differ: "));
    EXPECT_THAT(found.why, HasSubstr(" s, expected at most "));
  }
}

TEST(AlignMotions, DifferentShortMotionsAreRefused) {
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    const Recording a{.length_s = 2.5, .camera = CameraAround(0)}, b{.length_s = 2.5, .camera = CameraAround(60)};
    const MotionAlignment found = AlignMotions(Record(Dance(seed), a), Record(Dance(seed + 40), b));
    EXPECT_FALSE(found.found) << seed << ": " << found.distance_m << " m, " << found.overlap_s << " s";
  }
}

TEST(AlignMotions, NothingIsSeenByBoth) {
  const Recording a{.length_s = 4, .camera = CameraAround(0)};
  const ViewMotion seen = Record(Dance(1), a);
  ViewMotion unknown = seen;
  for (MatrixX3d& points : unknown.points) points.setConstant(std::numeric_limits<double>::quiet_NaN());
  for (const bool first : {true, false}) {
    const MotionAlignment found = first ? AlignMotions(unknown, seen) : AlignMotions(seen, unknown);
    EXPECT_FALSE(found.found);
    EXPECT_THAT(found.why, HasSubstr("no second of the clips in which both show the person"));
    EXPECT_EQ(found.score, 0);
  }
  // Known for less than a second.
  for (size_t i = 0; i < 20; ++i) unknown.points[i] = seen.points[i];
  EXPECT_FALSE(AlignMotions(seen, unknown).found);
}

/// Clips of different moments: whatever offset is tried, they show other motions.
TEST(AlignMotions, ClipsOfDifferentMomentsAreRefused) {
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    const Recording a{.length_s = 6, .camera = CameraAround(0)},
        b{.begin_s = 40, .length_s = 6, .camera = CameraAround(60)};
    const MotionAlignment found = AlignMotions(Record(Dance(seed), a), Record(Dance(seed), b));
    EXPECT_FALSE(found.found) << seed << ": " << found.distance_m;
  }
}

TEST(AlignMotions, ShortClipsNeedAThird) {
  const Recording a{.length_s = 0.7, .fps = 60, .camera = CameraAround(0)},
      b{.begin_s = 0.2, .length_s = 0.7, .fps = 60, .offset_s = 0.1, .camera = CameraAround(60)};
  const MotionAlignment found = AlignMotions(Record(Dance(8), a), Record(Dance(8), b));
  ASSERT_TRUE(found.found) << found.why;
  EXPECT_NEAR(found.offset_s, 0.1, 0.02);
  // One frame, whose pose many moments may have.
  ViewMotion one = Record(Dance(8), a);
  one.points.resize(1);
  one.timestamps.resize(1);
  EXPECT_TRUE(AlignMotions(one, one).found);
}

TEST(AlignMotions, ContractErrors) {
  const ViewMotion motion = Record(Dance(1), {.length_s = 2});
  EXPECT_THROW(AlignMotions(motion, ViewMotion()), std::invalid_argument);
  EXPECT_THROW(AlignMotions(ViewMotion(), motion), std::invalid_argument);
  ViewMotion wrong = motion;
  wrong.timestamps.pop_back();
  EXPECT_THROW(AlignMotions(wrong, motion), std::invalid_argument);
  wrong = motion;
  for (MatrixX3d& points : wrong.points) points.conservativeResize(kPoints - 1, 3);
  EXPECT_THROW(AlignMotions(motion, wrong), std::invalid_argument);
  wrong = motion;
  wrong.points[5].conservativeResize(kPoints - 1, 3);
  EXPECT_THROW(AlignMotions(wrong, motion), std::invalid_argument);
  wrong = motion;
  wrong.timestamps[7] = wrong.timestamps[6];
  EXPECT_THROW(AlignMotions(motion, wrong), std::invalid_argument);
}

TEST(AlignMotions, TenMinutesTakeTwoSeconds) {
  const Recording a{.length_s = 600, .fps = 60, .noise_m = 0.05, .camera = CameraAround(0)},
      b{.begin_s = 45, .length_s = 600, .fps = 60, .offset_s = -7.3, .noise_m = 0.05, .camera = CameraAround(100)};
  const ViewMotion of_a = Record(Dance(9), a, 1), of_b = Record(Dance(9), b, 2);
  const std::clock_t begin = std::clock();  // of the processor: others use it, too
  const MotionAlignment found = AlignMotions(of_a, of_b);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 2);
  ASSERT_TRUE(found.found) << found.why;
  EXPECT_NEAR(found.offset_s, -7.3, 2 * kFine_s);
  EXPECT_LE(RotationError(found, a, b), 0.01);
}

}  // namespace
}  // namespace bodyloom::align_motions_test
