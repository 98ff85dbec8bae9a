// SPDX-License-Identifier: Apache-2.0
// Sizes of people from feet on one plane: closed forms, a search over all sizes, and scenes that do not determine them.
#include "tracking/room/common_ground.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "geometry/math/rotation.h"
#include "tracking/initialise/ground_plane.h"
#include "tracking/solvers/residuals/ceres_functions.h"

namespace bodyloom::common_ground_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Up of a camera that looks 12° down and is rolled by 3°.
Vector3d TiltedUp() {
  return RotationFromAxisAngle(Vector3d(0, 0, 0.05)) * RotationFromAxisAngle(Vector3d(0.21, 0, 0)) * Vector3d(0, -1, 0);
}

struct PersonOnPlane {
  double size = 1;      ///< of what their fit assumed
  double beside_m = 0;  ///< where they stand, across the view and along it
  double ahead_m = 5;
  double above_m = 0;  ///< of the plane
  int steps = 150;
  double seconds = 1;  ///< of each
  double noise_m = 0;
  uint64_t seed = 1;
};

/// Steps within a square of 1.6 m, as the person's own fit has them.
StandingPerson Stand(const PersonOnPlane& person, const Vector3d& up, double camera_height_m) {
  std::mt19937_64 random(person.seed);
  std::uniform_real_distribution<double> uniform(-0.8, 0.8);
  std::normal_distribution<double> normal;
  const Vector3d ahead = (Vector3d::UnitZ() - up.z() * up).normalized(), beside = up.cross(ahead);
  StandingPerson standing;
  for (int i = 0; i < person.steps; ++i) {
    const double stepped_ahead_m = person.ahead_m + uniform(random),
                 stepped_beside_m = person.beside_m + uniform(random);
    const Vector3d place =
        (person.above_m - camera_height_m) * up + stepped_ahead_m * ahead + stepped_beside_m * beside;
    const Vector3d noise{normal(random), normal(random), normal(random)};
    standing.stances.push_back({.begin = 10 * i,
                                .end = 10 * i + 8,
                                .seconds = person.seconds,
                                .place_m = place / person.size + person.noise_m * noise});
  }
  return standing;
}

TEST(CommonGround, ExactPlaneGivesTheRatioOfSizesAndTheirMeanStaysOne) {
  const Vector3d up = TiltedUp();
  const std::vector<StandingPerson> people = {Stand({.size = 1.08, .beside_m = -1}, up, 1.5),
                                              Stand({.size = 0.95, .beside_m = 1, .ahead_m = 4, .seed = 2}, up, 1.5)};
  const CommonGround ground = FindCommonGround(people, up);
  ASSERT_TRUE(ground.found) << ground.why;
  EXPECT_NEAR(ground.size[0] / ground.size[1], 1.08 / 0.95, 0.003 * 1.08 / 0.95);
  EXPECT_NEAR(ground.size[0] * ground.size[1], 1, 1e-3);
  EXPECT_NEAR(ground.ground.camera_height_m, 1.5 / std::sqrt(1.08 * 0.95), 0.01);
  EXPECT_LT((ground.ground.up - up).norm(), 0.003);
  EXPECT_NEAR(ground.ground.up.norm(), 1, 1e-12);
}

TEST(CommonGround, AKnownSizeMakesTheOthersKnown) {
  const Vector3d up = TiltedUp();
  std::vector<StandingPerson> people = {Stand({.size = 1, .beside_m = -1}, up, 1.5),
                                        Stand({.size = 0.9, .beside_m = 1, .ahead_m = 4, .seed = 2}, up, 1.5)};
  people[0].size_known = true;
  const CommonGround ground = FindCommonGround(people, up);
  ASSERT_TRUE(ground.found) << ground.why;
  EXPECT_EQ(ground.size[0], 1);
  EXPECT_NEAR(ground.size[1], 0.9, 0.005);
  EXPECT_NEAR(ground.ground.camera_height_m, 1.5, 0.01);
}

TEST(CommonGround, AnUpThatIsOffIsPutRightByFeetThatWander) {
  const Vector3d up = TiltedUp(), off = RotationFromAxisAngle(Vector3d(0.05, 0, -0.03)) * up;
  std::vector<StandingPerson> people;
  for (const double size : {1.06, 0.94}) {
    people.push_back(Stand({.size = size, .beside_m = 20 * (size - 1), .seed = 7}, up, 1.5));
  }
  const CommonGround ground = FindCommonGround(people, off);
  ASSERT_TRUE(ground.found) << ground.why;
  EXPECT_GT(std::acos(off.dot(up)), 0.05);
  EXPECT_LT(std::acos(ground.ground.up.dot(up)), 0.012);
  EXPECT_NEAR(ground.size[0] / ground.size[1], 1.06 / 0.94, 0.02);
}

TEST(CommonGround, StepsOnABeamDoNotCount) {
  const Vector3d up = TiltedUp();
  StandingPerson first = Stand({.size = 1.08, .beside_m = -1}, up, 1.5);
  const StandingPerson second = Stand({.size = 0.95, .beside_m = 1, .ahead_m = 4, .seed = 2}, up, 1.5);
  const StandingPerson on_beam = Stand({.size = 1.08, .beside_m = -1, .above_m = 0.4, .steps = 60, .seed = 3}, up, 1.5);
  first.stances.insert(first.stances.end(), on_beam.stances.begin(), on_beam.stances.end());
  const CommonGround ground = FindCommonGround({first, second}, up);
  ASSERT_TRUE(ground.found) << ground.why;
  EXPECT_NEAR(ground.size[0] / ground.size[1], 1.08 / 0.95, 0.01);
  EXPECT_EQ(ground.stands, (std::vector<char>{1, 1}));
}

TEST(CommonGround, WhoeverStandsOnAStageIsNotTakenForATinyPerson) {
  const Vector3d up = TiltedUp();
  const std::vector<StandingPerson> people = {Stand({.size = 1.05, .beside_m = -1}, up, 1.5),
                                              Stand({.size = 0.97, .ahead_m = 4, .seed = 2}, up, 1.5),
                                              Stand({.size = 1, .beside_m = 1.5, .above_m = 1, .seed = 3}, up, 1.5)};
  const CommonGround ground = FindCommonGround(people, up);
  ASSERT_TRUE(ground.found) << ground.why;
  EXPECT_EQ(ground.stands, (std::vector<char>{1, 1, 0}));
  EXPECT_EQ(ground.size[2], 1);
  EXPECT_NEAR(ground.size[0] / ground.size[1], 1.05 / 0.97, 0.005);
  // With one other person nobody can say who stands on the floor.
  const CommonGround two = FindCommonGround({people[0], people[2]}, up);
  EXPECT_FALSE(two.found);
  EXPECT_EQ(two.size, (std::vector<double>{1, 1}));
  EXPECT_NE(two.why.find("one plane"), std::string::npos) << two.why;
}

TEST(CommonGround, WhereNothingCanBeSaidItSaysWhy) {
  const Vector3d up = TiltedUp();
  const StandingPerson one = Stand({.size = 1.08}, up, 1.5);
  const CommonGround nobody = FindCommonGround({{}, {}}, up);
  EXPECT_FALSE(nobody.found);
  EXPECT_NE(nobody.why.find("nobody"), std::string::npos) << nobody.why;
  EXPECT_FALSE(FindCommonGround({}, up).found);
  const CommonGround alone = FindCommonGround({one}, up);
  EXPECT_FALSE(alone.found);
  EXPECT_EQ(alone.stands, std::vector<char>{1});
  EXPECT_EQ(alone.size, std::vector<double>{1});
  // The other one stands for 0.3 s.
  const CommonGround briefly =
      FindCommonGround({one, Stand({.size = 0.9, .steps = 1, .seconds = 0.3, .seed = 2}, up, 1.5)}, up);
  EXPECT_FALSE(briefly.found);
  EXPECT_EQ(briefly.stands, (std::vector<char>{1, 0}));
  EXPECT_NE(briefly.why.find("one person"), std::string::npos) << briefly.why;
  EXPECT_THROW(FindCommonGround({one, one}, 1.1 * up), std::invalid_argument);
}

TEST(CommonGround, ACameraNearThePlaneShowsNoSizes) {
  const Vector3d up(0, -1, 0);
  for (const double height : {0.25, -0.2}) {
    const CommonGround ground = FindCommonGround({Stand({.size = 1.08, .beside_m = -1}, up, height),
                                                  Stand({.size = 0.95, .beside_m = 1, .seed = 2}, up, height)},
                                                 up);
    ASSERT_TRUE(ground.found) << ground.why;
    EXPECT_EQ(ground.size, (std::vector<double>{1, 1})) << height;
    EXPECT_NEAR(ground.ground.camera_height_m, height, 0.03);
    EXPECT_NE(ground.why.find("too near"), std::string::npos) << ground.why;
  }
  // Feet above a camera in a pit tell as well as those below one on a mast.
  const CommonGround pit = FindCommonGround(
      {Stand({.size = 1.08, .beside_m = -1}, up, -1.5), Stand({.size = 0.95, .beside_m = 1, .seed = 2}, up, -1.5)}, up);
  ASSERT_TRUE(pit.found) << pit.why;
  EXPECT_NEAR(pit.size[0] / pit.size[1], 1.08 / 0.95, 0.005);
}

TEST(CommonGround, SizesThatAreKeptAreNotSought) {
  const Vector3d up = TiltedUp();
  const std::vector<StandingPerson> people = {Stand({.size = 1.02, .beside_m = -1}, up, 1.5),
                                              Stand({.size = 0.98, .beside_m = 1, .seed = 2}, up, 1.5)};
  const CommonGround ground = FindCommonGround(people, up, {.size_sigma = 0});
  ASSERT_TRUE(ground.found) << ground.why;
  EXPECT_EQ(ground.size, (std::vector<double>{1, 1}));
  EXPECT_EQ(ground.why.find("too near"), std::string::npos) << ground.why;
}

/// Reference implementation of the header's definition: for given sizes the rest is nearly linear and is solved by
/// reweighted least squares from several heights.
class Twin {
 public:
  Twin(const std::vector<StandingPerson>& people, const Vector3d& up) : people_(people), up_(up) {
    e1_ = up.unitOrthogonal();
    e2_ = up.cross(e1_);
  }
  [[nodiscard]] double Cost(const std::vector<double>& log_size, const Vector3d& up, double height) const {
    double cost = std::pow(up.dot(e1_) / 0.06, 2) + std::pow(up.dot(e2_) / 0.06, 2);
    for (size_t i = 0; i < people_.size(); ++i) {
      cost += std::pow(log_size[i] / 0.08, 2);
      for (const StandingFoot& stance : people_[i].stances) {
        const double s = std::pow(up.dot(stance.place_m) + height / std::exp(log_size[i]), 2) / Variance(stance);
        cost += std::min(1.0, stance.seconds) * 9 * s / (9 + s);
      }
    }
    return cost;
  }
  [[nodiscard]] double MinCost(const std::vector<double>& log_size, double height) const {
    double minimum = std::numeric_limits<double>::infinity();
    for (const double times : {0.8, 0.9, 1.0, 1.1, 1.2}) {
      Vector3d x(0, 0, times * height);  // up₀ + a e₁ + b e₂, h
      for (int pass = 0; pass < 25; ++pass) {
        Matrix3d H = Vector3d(1 / (0.06 * 0.06), 1 / (0.06 * 0.06), 0).asDiagonal();
        Vector3d rhs = Vector3d::Zero();
        for (size_t i = 0; i < people_.size(); ++i) {
          for (const StandingFoot& stance : people_[i].stances) {
            const Vector3d& p = stance.place_m;
            const Vector3d row(e1_.dot(p), e2_.dot(p), std::exp(-log_size[i]));
            const double s = std::pow(up_.dot(p) + row.dot(x), 2) / Variance(stance);
            const double weight = std::min(1.0, stance.seconds) * std::pow(9 / (9 + s), 2) / Variance(stance);
            H += weight * row * row.transpose();
            rhs -= weight * up_.dot(p) * row;
          }
        }
        x = H.ldlt().solve(rhs);
      }
      const double length = (up_ + x[0] * e1_ + x[1] * e2_).norm();
      minimum = std::min(minimum, Cost(log_size, (up_ + x[0] * e1_ + x[1] * e2_) / length, x[2] / length));
    }
    return minimum;
  }

 private:
  [[nodiscard]] double Variance(const StandingFoot& stance) const {
    return 0.03 * 0.03 + std::pow(0.12 * up_.dot(stance.place_m) / stance.place_m.norm(), 2);
  }
  const std::vector<StandingPerson>& people_;
  Vector3d up_, e1_, e2_;
};

struct GridScene {
  const char* what;
  double tall, small, camera_height_m;
  int steps_on_beam;  ///< of the first person, beside nine on the floor
};

class NoSizesOnAGridCostLess : public testing::TestWithParam<GridScene> {};

TEST_P(NoSizesOnAGridCostLess, ThanThoseThatAreFound) {
  const GridScene& scene = GetParam();
  const Vector3d up = TiltedUp();
  for (uint64_t seed = 1; seed <= 3; ++seed) {
    const double height = scene.camera_height_m;
    const PersonOnPlane tall{.size = scene.tall, .beside_m = -1, .seconds = 0.5, .noise_m = 0.02};
    const auto stand = [&](PersonOnPlane person, double above_m, int steps, uint64_t s) {
      person.above_m = above_m;
      person.steps = steps;
      person.seed = s;
      return Stand(person, up, height);
    };
    std::vector<StandingPerson> people = {
        stand(tall, 0, 9, seed),
        stand({.size = scene.small, .beside_m = 1, .ahead_m = 3.5, .seconds = 0.5, .noise_m = 0.02}, 0, 7, 10 + seed)};
    const StandingPerson beam = stand(tall, 0.4, scene.steps_on_beam, 20 + seed);
    people[0].stances.insert(people[0].stances.end(), beam.stances.begin(), beam.stances.end());
    const CommonGround ground = FindCommonGround(people, up);
    ASSERT_TRUE(ground.found) << ground.why;
    const Twin twin(people, up);
    double minimum = std::numeric_limits<double>::infinity();
    Vector2d best;
    constexpr double kStep = 0.01;
    for (double a = -0.24; a <= 0.24; a += kStep) {
      for (double b = -0.24; b <= 0.24; b += kStep) {
        const double cost = twin.MinCost({a, b}, height);
        if (cost < minimum) minimum = cost, best = {a, b};
      }
    }
    const std::vector<double> log_size = {std::log(ground.size[0]), std::log(ground.size[1])};
    EXPECT_LE(twin.Cost(log_size, ground.ground.up, ground.ground.camera_height_m), minimum + 1e-6) << seed;
    EXPECT_NEAR(log_size[0], best[0], 1.5 * kStep) << seed;
    EXPECT_NEAR(log_size[1], best[1], 1.5 * kStep) << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(CommonGround, NoSizesOnAGridCostLess,
                         testing::Values(GridScene{"OnTheFloor", 1.1, 0.93, 1.5, 0},
                                         GridScene{"AFewStepsOnABeam", 1.1, 0.93, 1.5, 4},
                                         GridScene{"MostStepsOnABeam", 1.1, 0.93, 1.5, 12},
                                         GridScene{"FarApartUnderAHighCamera", 1.2, 0.83, 3, 0},
                                         GridScene{"FarApartAndOnABeam", 1.2, 0.83, 3, 4}),
                         [](const auto& test) { return test.param.what; });

TEST(StanceCost, DerivativesAreDifferences) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int compared = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const Vector3d place{2 * uniform(random), 1 + uniform(random), 5 + uniform(random)};
    const StanceCost cost(place, 0.05 + 0.02 * uniform(random));
    std::array<double, 5> x = {0.2 * uniform(random), -1, 0.2 * uniform(random), 1.5 * uniform(random),
                               uniform(random)};
    if (trial == 0) x[3] = -(x[0] * place.x() + x[1] * place.y() + x[2] * place.z()) * std::exp(x[4]);  // on the plane
    const auto evaluate = [&](const std::array<double, 5>& at) {
      const std::array<const double*, 3> blocks = {at.data(), &at[3], &at[4]};
      double r = 0;
      EXPECT_TRUE(cost.Evaluate(blocks.data(), &r, nullptr));
      return r;
    };
    if (trial == 0) {
      EXPECT_NEAR(evaluate(x), 0, 1e-12);
    }
    std::array<double, 5> derivative{};
    const std::array<const double*, 3> blocks = {x.data(), &x[3], &x[4]};
    std::array<double*, 3> jacobians = {derivative.data(), &derivative[3], &derivative[4]};
    double r = 0;
    ASSERT_TRUE(cost.Evaluate(blocks.data(), &r, jacobians.data()));
    for (int k = 0; k < 5; ++k, ++compared) {
      std::array<double, 5> more = x, less = x;
      more[k] += 1e-5;
      less[k] -= 1e-5;
      const double difference = (evaluate(more) - evaluate(less)) / 2e-5;
      EXPECT_NEAR(derivative[k], difference, 1e-7 * (1 + std::abs(difference))) << trial << " " << k;
    }
  }
  EXPECT_EQ(compared, 100);
}

TEST(GemanMcClureLoss, DerivativesAreDifferencesAndItIsTheKernelOfImages) {
  const GemanMcClureLoss loss(3);
  for (const double s : {0.0, 0.5, 9.0, 200.0}) {
    std::array<double, 3> at{}, more{}, less{};
    loss.Evaluate(s, at.data());
    loss.Evaluate(s + 1e-5, more.data());
    loss.Evaluate(s - 1e-5, less.data());
    EXPECT_EQ(at[0], GemanMcClure(s, 3).rho);
    EXPECT_NEAR(at[1], (more[0] - less[0]) / 2e-5, 1e-8) << s;
    EXPECT_NEAR(at[2], (more[1] - less[1]) / 2e-5, 1e-8) << s;
  }
}

}  // namespace
}  // namespace bodyloom::common_ground_test
