// SPDX-License-Identifier: Apache-2.0
// Estimated motion level against a joint that turns with a known acceleration.
#include "tracking/clip/clip_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/math/rotation.h"
#include "tests/support/frame_scene.h"

namespace bodyloom::motion_level_test {
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
  const std::vector<double> rms = TipAccelerationRms(TurningJoint(body, 1, 3));
  ASSERT_EQ(rms.size(), size_t(body.num_joints()));
  for (size_t j = 0; j < rms.size(); ++j) EXPECT_NEAR(rms[j], j == 1 ? 3 * lever : 0, 1e-9) << j;
  EXPECT_EQ(TipAccelerationRms(TurningJoint(body, 1, 0))[1], 0);
}

TEST(MotionLevel, SmoothnessFollowsItWithinItsRange) {
  const BodyModel body{ToyBodyData()};
  const double lever = JointLevers(body)[1];
  const Smoothness start;
  const auto fitted = [&](double tip) { return FitSmoothness(TurningJoint(body, 1, tip / lever), start)[0]; };
  EXPECT_NEAR(fitted(7).tip_acceleration, 7 * kSigmaOfRms, 1e-6);
  EXPECT_NEAR(fitted(7).root_acceleration, start.root_acceleration * 28 / 25, 1e-6);
  EXPECT_NEAR(fitted(7).of_joint[1], 7 * kSigmaOfRms, 1e-6);
  EXPECT_EQ(fitted(7).of_joint[0], kMinOfJoint);
  EXPECT_EQ(fitted(30).of_joint[1], kMaxOfJoint);
  EXPECT_TRUE(fitted(0).of_joint.empty());
  EXPECT_EQ(fitted(0.5).tip_acceleration, kMinSigma);
  EXPECT_EQ(fitted(30).tip_acceleration, kMaxSigma);
  EXPECT_EQ(fitted(0).tip_acceleration, start.tip_acceleration);
}

TEST(MotionLevel, EveryShotHasItsOwn) {
  const BodyModel body{ToyBodyData()};
  const double lever = JointLevers(body)[1];
  SequenceProblem both = TurningJoint(body, 1, 7 / lever);
  const SequenceProblem second = TurningJoint(body, 1, 3 / lever);
  both.states.insert(both.states.end(), second.states.begin(), second.states.end());
  for (const double s : second.timestamps) both.timestamps.push_back(s + 12 / 15.0);
  both.cut_before.resize(24, 0);
  both.cut_before[12] = 1;
  const std::vector<Smoothness> fitted = FitSmoothness(both, Smoothness());
  ASSERT_EQ(fitted.size(), 2U);
  EXPECT_NEAR(fitted[0].of_joint[1], 7 * kSigmaOfRms, 1e-6);
  EXPECT_NEAR(fitted[1].of_joint[1], 3 * kSigmaOfRms, 1e-6);
}

TEST(MotionLevel, SigmaOfEachJointTakesTheCommonOnesPlace) {
  const BodyModel body{ToyBodyData()};
  SequenceProblem problem = TurningJoint(body, 1, 3);
  const std::vector<double> levers = JointLevers(body);
  EXPECT_DOUBLE_EQ(JointAccelerationSigma(problem)[1], 25 / levers[1]);
  problem.smoothness[0].of_joint.assign(body.num_joints(), 12);
  problem.smoothness[0].of_joint[1] = 50;
  EXPECT_DOUBLE_EQ(JointAccelerationSigma(problem)[0], 12 / levers[0]);
  EXPECT_DOUBLE_EQ(JointAccelerationSigma(problem)[1], 50 / levers[1]);
}

}  // namespace
}  // namespace bodyloom::motion_level_test
