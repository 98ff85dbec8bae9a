// SPDX-License-Identifier: Apache-2.0
// Scenes merged from the fits of several people: closed forms.
#include "tracking/room/shared_scene.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace bodyloom::shared_scene_test {
namespace {

using Eigen::Vector3d;

TrackSequenceSummary Person(double focal_px, double focal_log_sigma) {
  TrackSequenceSummary person;
  person.status = SolveStatus::kConverged;
  person.focal_px = focal_px;
  person.focal_log_sigma = focal_log_sigma;
  person.frames_by_status["tracked"] = 10;
  return person;
}

/// Somebody whose own fit puts the camera so high above the plane on which they make ten steps.
TrackSequenceSummary PersonOnGround(const Vector3d& up, double spread_deg, double camera_height_m, double seconds) {
  TrackSequenceSummary person = Person(1000, 0);
  person.ground.has_up = true;
  person.ground.up = up.normalized();
  person.ground.up_spread_deg = spread_deg;
  person.ground.has_plane = true;
  person.ground.camera_height_m = camera_height_m;
  person.ground.contact_frames = 10;
  const Vector3d beside = up.normalized().unitOrthogonal(), ahead = beside.cross(up.normalized());
  const double sign = ahead.z() < 0 ? -1 : 1;
  for (int i = 0; i < 10; ++i) {
    person.ground.stances.push_back(
        {.begin = i,
         .end = i + 1,
         .seconds = seconds / 10,
         .place_m = -camera_height_m * up.normalized() + sign * (4 + i % 3) * ahead + (i % 4) * beside});
  }
  return person;
}

/// A fit's posterior when its clip measured log f = x with this variance.
TrackSequenceSummary Measured(double x, double variance, const FocalPrior& prior) {
  const double prior_information = 1 / (prior.log_sigma * prior.log_sigma), own = prior_information + 1 / variance;
  return Person(std::exp((prior_information * prior.log_mean + x / variance) / own), 1 / std::sqrt(own));
}

TEST(SharedScene, FocalLengthsAreMeasurementsWithAnErrorInCommonAndOnePrior) {
  const FocalPrior prior{.log_mean = std::log(900), .log_sigma = 0.25};
  const std::vector<std::pair<double, double>> measured = {
      {std::log(700), 1.0 / 40}, {std::log(1500), 0.1}, {std::log(1000), 1e-5}};
  // log f and the three errors as one Gaussian: x = log f + common + own.
  Eigen::Vector3d x;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Constant(kFocalFitLogSigma * kFocalFitLogSigma);
  std::vector<TrackSequenceSummary> people;
  for (int i = 0; i < 3; ++i) {
    x[i] = measured[i].first;
    covariance(i, i) += measured[i].second;
    people.push_back(Measured(x[i], measured[i].second, prior));
  }
  // Weights as if the errors were each person's own, as the header has them; what they leave is exact.
  const double b2 = kFocalFitLogSigma * kFocalFitLogSigma;
  Eigen::Vector3d w;
  for (int i = 0; i < 3; ++i) w[i] = 1 / (measured[i].second + b2);
  w /= w.sum();
  const double v = w.dot(covariance * w), information = 1 / (0.25 * 0.25) + 1 / v;
  const SharedScene scene = JoinScenes(people, prior);
  EXPECT_NEAR(std::log(scene.focal_px), (prior.log_mean / (0.25 * 0.25) + w.dot(x) / v) / information, 1e-9);
  EXPECT_NEAR(scene.focal_log_sigma, 1 / std::sqrt(information), 1e-9);
  EXPECT_GT(scene.focal_log_sigma, 0.2) << "however sure each fit is";
}

TEST(SharedScene, OnePersonsFocalLengthStaysAndIsAsUncertainAsFitsAre) {
  const SharedScene scene = JoinScenes({Person(700, 0.01)}, {.log_mean = std::log(900), .log_sigma = 0.25});
  EXPECT_EQ(scene.focal_px, 700);
  EXPECT_NEAR(scene.focal_log_sigma, std::hypot(0.01, kFocalFitLogSigma), 1e-12);
}

TEST(SharedScene, SomebodyWhoShowsNothingOfTheFocalLengthChangesNothing) {
  const FocalPrior prior{.log_mean = std::log(900), .log_sigma = 0.25};
  TrackSequenceSummary failed = Person(500, 0.01);
  failed.status = SolveStatus::kFailure;
  const SharedScene with = JoinScenes({Person(700, 0.1), Person(900, 0.25)}, prior),
                    without = JoinScenes({Person(700, 0.1), failed}, prior);
  EXPECT_NEAR(with.focal_px, without.focal_px, 1e-9);
  EXPECT_NEAR(with.focal_log_sigma, without.focal_log_sigma, 1e-12);
  const SharedScene nothing = JoinScenes({Person(900, 0.25), Person(900, 0.25)}, prior);
  EXPECT_NEAR(nothing.focal_px, 900, 1e-9);
  EXPECT_NEAR(nothing.focal_log_sigma, 0.25, 1e-12);
}

TEST(SharedScene, AKnownFocalLengthStaysAndFailuresAndUnknownSpreadsAreLeftOut) {
  const FocalPrior prior{std::log(900), 0.25};
  TrackSequenceSummary failed = Person(500, 0.01);
  failed.status = SolveStatus::kFailure;
  const SharedScene known = JoinScenes({failed, Person(1234, 0)}, {});
  EXPECT_EQ(known.focal_px, 1234);
  EXPECT_EQ(known.focal_log_sigma, 0);
  const SharedScene scene = JoinScenes({failed, Person(800, std::nan("")), Person(700, 0.1)}, prior);
  EXPECT_NEAR(scene.focal_px, JoinScenes({failed, Person(700, 0.1)}, prior).focal_px, 1e-9);
  EXPECT_EQ(JoinScenes({failed}, {}).focal_px, 0);
  EXPECT_EQ(JoinScenes({Person(800, std::nan(""))}, {}).focal_px, 0);
}

TEST(SharedScene, TheVerticalIsTheMeanThatSpreadsWeigh) {
  const SharedScene scene = JoinScenes(
      {PersonOnGround(Vector3d(0.1, -1, 0), 0, 1.5, 0), PersonOnGround(Vector3d(-0.1, -1, 0), 2, 1.5, 0)}, {});
  ASSERT_TRUE(scene.has_up);
  // Weights 1/2² and 1/4².
  const Vector3d expected = (4 * Vector3d(0.1, -1, 0).normalized() + Vector3d(-0.1, -1, 0).normalized()).normalized();
  EXPECT_NEAR((scene.ground.up - expected).norm(), 0, 1e-12);
}

TEST(SharedScene, FeetOnOnePlaneRelateSizes) {
  const Vector3d up(0, -1, 0);
  const SharedScene two = JoinScenes({PersonOnGround(up, 1, 1.5, 5), PersonOnGround(up, 1, 1.7, 5)}, {});
  ASSERT_TRUE(two.ground.has_plane) << two.why;
  ASSERT_EQ(two.size.size(), 2U);
  EXPECT_NEAR(two.size[0] / two.size[1], 1.7 / 1.5, 0.01);
  EXPECT_NEAR(two.ground.camera_height_m, std::sqrt(1.5 * 1.7), 0.02);
}

TEST(SharedScene, AKnownStatureIsNotChanged) {
  const Vector3d up(0, -1, 0);
  TrackSequenceSummary known = PersonOnGround(up, 1, 1.5, 5);
  known.stature_m = 1.8;
  const SharedScene scene = JoinScenes({PersonOnGround(up, 1, 1.7, 5), known}, {});
  ASSERT_TRUE(scene.ground.has_plane) << scene.why;
  EXPECT_EQ(scene.size[1], 1);
  EXPECT_NEAR(scene.size[0], 1.5 / 1.7, 0.01);
  EXPECT_NEAR(scene.ground.camera_height_m, 1.5, 0.02);
}

TEST(SharedScene, PlacesFollowTheJoinedFocalLength) {
  // Seen from above, the same plane: the second person's fit took the focal length for 30 % longer, and so the person
  // to be so much farther away.
  const Vector3d up(0, -0.8, -0.6);
  TrackSequenceSummary first = PersonOnGround(up, 1, 1.5, 5), second = first;
  second.focal_px *= 1.3;
  for (StandingFoot& stance : second.ground.stances) stance.place_m.z() *= 1.3;
  const SharedScene scene = JoinScenes({first, second}, {});
  ASSERT_EQ(scene.focal_px, first.focal_px);
  ASSERT_TRUE(scene.ground.has_plane) << scene.why;
  EXPECT_NEAR(scene.size[0], 1, 1e-6);
  EXPECT_NEAR(scene.size[1], 1, 1e-6);
  EXPECT_NEAR(scene.ground.camera_height_m, 1.5, 1e-6);
}

TEST(SharedScene, OnePersonsGroundIsTheirOwn) {
  const Vector3d up(0, -1, 0);
  TrackSequenceSummary sits = Person(1000, 0);
  const SharedScene scene = JoinScenes({PersonOnGround(up, 1, 1.3, 3), sits}, {});
  ASSERT_TRUE(scene.ground.has_plane) << scene.why;
  EXPECT_EQ(scene.ground.camera_height_m, 1.3);
  EXPECT_EQ(scene.size, (std::vector<double>{1, 1}));
  EXPECT_EQ(scene.why, "feet of 10 frames stand on it");
  TrackSequenceSummary stairs = PersonOnGround(up, 1, 1.3, 3);
  stairs.ground.has_plane = false;
  stairs.ground.why = "feet do not stand at one height";
  const SharedScene none = JoinScenes({stairs}, {});
  EXPECT_FALSE(none.ground.has_plane);
  EXPECT_EQ(none.why, stairs.ground.why);
}

TEST(SharedScene, SomebodyOnAStageKeepsTheirSizeAndTheMostFeetHaveTheGround) {
  const Vector3d up(0, -1, 0);
  const SharedScene maximum = JoinScenes({PersonOnGround(up, 1, 1.5, 6), PersonOnGround(up, 1, 0.7, 3)}, {});
  ASSERT_TRUE(maximum.ground.has_plane) << maximum.why;
  EXPECT_EQ(maximum.ground.camera_height_m, 1.5);
  EXPECT_EQ(maximum.size, (std::vector<double>{1, 1}));
  const SharedScene none = JoinScenes({PersonOnGround(up, 1, 1.5, 3), PersonOnGround(up, 1, 0.7, 3)}, {});
  EXPECT_FALSE(none.ground.has_plane);
  EXPECT_NE(none.why.find("one plane"), std::string::npos) << none.why;
  const SharedScene nobody = JoinScenes({Person(1000, 0)}, {});
  EXPECT_FALSE(nobody.ground.has_plane);
  EXPECT_EQ(nobody.why, "the vertical is not clear");
}

}  // namespace
}  // namespace bodyloom::shared_scene_test
