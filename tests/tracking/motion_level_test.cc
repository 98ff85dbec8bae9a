// SPDX-License-Identifier: Apache-2.0
// How lively a motion is, against a joint that turns with a known acceleration.
#include "tracking/motion_level.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/rotation.h"
#include "tests/support/frame_scene.h"

namespace bodyloom {
namespace {

/// One estimated joint turns by ½ a t² about an axis, at 15 frames a second.
SequenceProblem TurningJoint(const BodyModel& body, int joint, double acceleration) {
  SequenceProblem problem;
  problem.layout = FrameLayout::Make(body, CameraKnowledge::kKnown, MakePinhole(640, 480, 500), {joint}, 0);
  for (int t = 0; t < 12; ++t) {
    const double s = t / 15.0;
    FrameState state;
    state.rotations.assign(body.num_joints(), Eigen::Matrix3d::Identity());
    state.rotations[joint] = RotationFromAxisAngle(Eigen::Vector3d(0.5 * acceleration * s * s, 0, 0));
    problem.states.push_back(state);
    problem.timestamps.push_back(s);
    problem.cut_before.push_back(0);
  }
  return problem;
}

TEST(MotionLevel, IsLeverTimesAngularAcceleration) {
  const BodyModel body{ToyBodyData()};
  const double lever = JointLevers(body)[1];
  EXPECT_NEAR(TipAccelerationRms(TurningJoint(body, 1, 3)), 3 * lever, 1e-9);
  EXPECT_EQ(TipAccelerationRms(SequenceProblem{TurningJoint(body, 1, 0)}), 0);
}

TEST(MotionLevel, SmoothnessFollowsItWithinItsRange) {
  const BodyModel body{ToyBodyData()};
  const double lever = JointLevers(body)[1];
  const Smoothness start;
  const auto fitted = [&](double tip) { return FitSmoothness(TurningJoint(body, 1, tip / lever), start); };
  EXPECT_NEAR(fitted(7).tip_acceleration, 7 * kSigmaOfRms, 1e-6);
  EXPECT_NEAR(fitted(7).root_acceleration, start.root_acceleration * 28 / 25, 1e-6);
  EXPECT_EQ(fitted(0.5).tip_acceleration, kLeastSigma);
  EXPECT_EQ(fitted(30).tip_acceleration, kMostSigma);
  EXPECT_EQ(fitted(0).tip_acceleration, start.tip_acceleration);
  SequenceProblem cut = TurningJoint(body, 1, 7 / lever);
  cut.cut_before[6] = 1;
  EXPECT_EQ(FitSmoothness(cut, start).tip_acceleration, start.tip_acceleration);
}

}  // namespace
}  // namespace bodyloom
