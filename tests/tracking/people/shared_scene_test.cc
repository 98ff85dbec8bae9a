// SPDX-License-Identifier: Apache-2.0
// Scenes joined from people's own fits: closed forms.
#include "bodyloom/tracking/people/shared_scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace bodyloom {
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

TrackSequenceSummary PersonOnGround(const Vector3d& up, double spread_deg, double camera_height_m, int contact_frames) {
  TrackSequenceSummary person = Person(1000, 0);
  person.ground.has_up = true;
  person.ground.up = up.normalized();
  person.ground.up_spread_deg = spread_deg;
  person.ground.has_plane = true;
  person.ground.camera_height_m = camera_height_m;
  person.ground.contact_frames = contact_frames;
  return person;
}

TEST(SharedScene, PosteriorsOfOnePriorGiveThePosteriorOfAllMeasurements) {
  const FocalPrior prior{.log_mean = std::log(900), .log_sigma = 0.25};
  const double prior_information = 1 / (0.25 * 0.25);
  const std::vector<std::pair<double, double>> measured = {{std::log(700), 40}, {std::log(1500), 10}, {7, 3}};
  double information = prior_information, sum = prior_information * prior.log_mean;
  std::vector<TrackSequenceSummary> people;
  for (const auto& [log_f, weight] : measured) {
    information += weight;
    sum += weight * log_f;
    const double own = prior_information + weight;
    people.push_back(Person(std::exp((prior_information * prior.log_mean + weight * log_f) / own), 1 / std::sqrt(own)));
  }
  const SharedScene scene = JoinScenes(people, prior);
  EXPECT_NEAR(std::log(scene.focal_px), sum / information, 1e-12);
  EXPECT_NEAR(scene.focal_log_sigma, 1 / std::sqrt(information), 1e-12);
}

TEST(SharedScene, SomebodyWhoShowsNothingOfTheFocalLengthChangesNothing) {
  const FocalPrior prior{.log_mean = std::log(900), .log_sigma = 0.25};
  const SharedScene scene = JoinScenes({Person(700, 0.1), Person(900, 0.25)}, prior);
  EXPECT_NEAR(scene.focal_px, 700, 1e-9);
  EXPECT_NEAR(scene.focal_log_sigma, 0.1, 1e-12);
}

TEST(SharedScene, AKnownFocalLengthStaysAndFailuresAndUnknownSpreadsAreLeftOut) {
  TrackSequenceSummary failed = Person(500, 0.01);
  failed.status = SolveStatus::kFailure;
  EXPECT_EQ(JoinScenes({failed, Person(1234, 0)}, {}).focal_px, 1234);
  const SharedScene scene =
      JoinScenes({failed, Person(800, std::nan("")), Person(700, 0.1)}, FocalPrior{std::log(900), 0.25});
  EXPECT_NEAR(scene.focal_px, 700, 1e-9);
  EXPECT_EQ(JoinScenes({failed}, {}).focal_px, 0);
}

TEST(SharedScene, TheVerticalIsTheMeanThatSpreadsWeigh) {
  const SharedScene scene = JoinScenes(
      {PersonOnGround(Vector3d(0.1, -1, 0), 0, 1.5, 10), PersonOnGround(Vector3d(-0.1, -1, 0), 2, 1.5, 10)}, {});
  ASSERT_TRUE(scene.has_up);
  // Weights 1/2² and 1/4².
  const Vector3d expected = (4 * Vector3d(0.1, -1, 0).normalized() + Vector3d(-0.1, -1, 0).normalized()).normalized();
  EXPECT_NEAR((scene.ground.up - expected).norm(), 0, 1e-12);
}

TEST(SharedScene, TheGroundIsWhatMostFeetStandOn) {
  const Vector3d up(0, -1, 0);
  const SharedScene two = JoinScenes({PersonOnGround(up, 1, 1.5, 30), PersonOnGround(up, 1, 1.6, 10)}, {});
  ASSERT_TRUE(two.ground.has_plane) << two.why;
  EXPECT_NEAR(two.ground.camera_height_m, (30 * 1.5 + 10 * 1.6) / 40, 1e-12);
  // One of them on a box.
  const SharedScene box = JoinScenes({PersonOnGround(up, 1, 1.5, 30), PersonOnGround(up, 1, 1.1, 10)}, {});
  ASSERT_TRUE(box.ground.has_plane);
  EXPECT_NEAR(box.ground.camera_height_m, 1.5, 1e-12);
  const SharedScene none =
      JoinScenes({PersonOnGround(up, 1, 1.5, 30), PersonOnGround(up, 1, 1.1, 30), PersonOnGround(up, 1, 2, 30)}, {});
  EXPECT_FALSE(none.ground.has_plane);
  EXPECT_NE(none.why.find("one plane"), std::string::npos) << none.why;
}

}  // namespace
}  // namespace bodyloom
