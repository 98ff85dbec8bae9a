// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/world_drift.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::world_drift_test {
namespace {

constexpr int kFrames = 60;  // at 20 a second

/// Somebody who glides at 1 m/s with limbs that stay.
Track Gliding() {
  Track track;
  track.motion.body = "smpl";
  track.motion.betas = Eigen::VectorXd::Zero(6);
  track.motion.poses = RandomAxisAngle(ToyBody(), 1, 0.6).transpose().replicate(kFrames, 1);
  track.motion.trans.resize(kFrames, 3);
  for (int t = 0; t < kFrames; ++t) {
    track.motion.trans.row(t) << t / 20.0, 0, 4;
    track.motion.timestamps.push_back(t / 20.0);
    track.frame_status.push_back(FrameStatus::kTracked);
  }
  return track;
}

TEST(WorldDrift, ARigidlyMovedTrackHasNone) {
  const Track truth = Gliding();
  const CameraPose elsewhere{RotationFromAxisAngle({0.4, 1, -0.3}), {3, 2, 1}};
  Track moved = truth;
  moved.motion = MovedMotion(ToyBody(), truth.motion, {&elsewhere, 1});
  const WorldDrift drift = MeasureWorldDrift(moved, truth, ToyBody());
  EXPECT_LT(drift.w_mpjpe_m, 1e-9);
  EXPECT_LT(drift.wa_mpjpe_m, 1e-9);
  EXPECT_LT(drift.root_drift, 1e-9);
  EXPECT_TRUE(std::isnan(drift.foot_slide_mps)) << "no foot stands";
}

TEST(WorldDrift, ATrackThatDriftsIsOffByWhatItDrifted) {
  const Track truth = Gliding();
  Track drifting = truth;
  // After the first second (21 frames) it goes up by 0.1 m a second.
  for (int t = 20; t < kFrames; ++t) drifting.motion.trans(t, 1) -= 0.1 * (t - 20) / 20.0;
  const WorldDrift drift = MeasureWorldDrift(drifting, truth, ToyBody());
  double expected = 0;
  for (int t = 20; t < kFrames; ++t) expected += 0.1 * (t - 20) / 20.0 / kFrames;
  EXPECT_NEAR(drift.w_mpjpe_m, expected, 1e-6);
  EXPECT_LT(drift.wa_mpjpe_m, expected);
  EXPECT_GT(drift.wa_mpjpe_m, 0.2 * expected);
  EXPECT_GT(drift.root_drift, 0);
}

TEST(WorldDrift, FeetThatStandAreSeenToSlide) {
  Track truth = Gliding();
  truth.motion.trans.col(0).setZero();
  Track sliding = Gliding();
  const WorldDrift drift = MeasureWorldDrift(sliding, truth, ToyBody());
  EXPECT_NEAR(drift.foot_slide_mps, 1, 1e-9);
  EXPECT_TRUE(std::isnan(drift.root_drift));
  sliding.motion.poses.conservativeResize(3, Eigen::NoChange);
  EXPECT_THROW(MeasureWorldDrift(sliding, truth, ToyBody()), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::world_drift_test
