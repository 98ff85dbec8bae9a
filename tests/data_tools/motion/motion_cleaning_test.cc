// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/motion_cleaning.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "data_tools/motion/smpl_rest.h"
#include "geometry/math/rotation.h"
#include "tests/data_tools/motion/motion_support.h"

namespace bodyloom::motion_cleaning_test {
namespace {

constexpr int kLeftHip = 1, kSpine1 = 3, kLeftAnkle = 7, kLeftToe = 10;

TEST(MotionCleaning, ASoundMotionStaysAsItIs) {
  const Motion motion = WalkingMotion(60, 3);
  const CleanedMotion cleaned = CleanMotion(motion);
  ASSERT_EQ(cleaned.pieces.size(), 1);
  EXPECT_EQ(cleaned.pieces[0].poses, motion.poses);
  EXPECT_EQ(cleaned.pieces[0].trans, motion.trans);
  EXPECT_EQ(cleaned.pieces[0].timestamps, motion.timestamps);
  EXPECT_EQ(cleaned.frames_mended + cleaned.frames_broken + cleaned.jumps + cleaned.gaps + cleaned.frames_dropped, 0);
}

TEST(MotionCleaning, AFrameOfGarbageGoesWithItsNeighbours) {
  Motion motion = StandingMotion(100, 3);
  motion.trans(120, 0) += 1;
  const CleanedMotion cleaned = CleanMotion(motion);
  EXPECT_EQ(cleaned.jumps, 2);
  ASSERT_EQ(cleaned.pieces.size(), 2);
  // 0.04 s are four frames: the steps 119-120 and 120-121 take 115..123+1 with them.
  EXPECT_NEAR(cleaned.pieces[0].timestamps.back(), 1.14, 1e-9);
  EXPECT_NEAR(cleaned.pieces[1].timestamps.front(), 1.26, 1e-9);
  EXPECT_EQ(cleaned.pieces[0].num_frames() + cleaned.pieces[1].num_frames() + cleaned.frames_dropped,
            motion.num_frames());
}

TEST(MotionCleaning, EachLimitCutsAboveAndNotBelow) {
  const auto jumps = [](auto change) {
    Motion motion = StandingMotion(100, 2);
    for (int t = 100; t < motion.num_frames(); ++t) change(&motion, t);
    return CleanMotion(motion).jumps;
  };
  EXPECT_EQ(jumps([](Motion* m, int t) { m->trans(t, 2) += 0.14; }), 0) << "14 m/s";
  EXPECT_EQ(jumps([](Motion* m, int t) { m->trans(t, 2) += 0.16; }), 1) << "16 m/s";
  EXPECT_EQ(jumps([](Motion* m, int t) { m->poses(t, 1) = 0.19; }), 0) << "19 rad/s of the root";
  EXPECT_EQ(jumps([](Motion* m, int t) { m->poses(t, 1) = 0.41; }), 1) << "41 rad/s of the root";
  // The hand is 0.59 m from the shoulder.
  EXPECT_EQ(jumps([](Motion* m, int t) { m->poses(t, 3 * 16 + 1) = 0.35; }), 0) << "20 m/s of a hand";
  EXPECT_EQ(jumps([](Motion* m, int t) { m->poses(t, 3 * 16 + 1) = 0.40; }), 1) << "23 m/s of a hand";
}

TEST(MotionCleaning, CutsAtGapsAndDropsShortPieces) {
  Motion motion = StandingMotion(100, 2);
  for (int t = 150; t < motion.num_frames(); ++t) motion.timestamps[t] += 0.02;
  for (int t = 180; t < motion.num_frames(); ++t) motion.timestamps[t] += 0.5;
  const CleanedMotion cleaned = CleanMotion(motion);
  EXPECT_EQ(cleaned.gaps, 2);
  ASSERT_EQ(cleaned.pieces.size(), 1);
  EXPECT_EQ(cleaned.pieces[0].num_frames(), 150);
  EXPECT_EQ(cleaned.frames_dropped, motion.num_frames() - 150);
}

TEST(MotionCleaning, AThighRolledAroundAndASpineFoldedAreBroken) {
  Motion motion = StandingMotion(100, 4);
  // Rolled about its own axis by 150°, and lifted: the knee would bend backwards.
  const Eigen::Matrix3d lifted = RotationFromAxisAngle(Eigen::Vector3d(-0.8, 0, 0));
  const auto rolled_by = [&](double degrees) {
    return AxisAngleFromRotation(lifted * RotationFromAxisAngle(Eigen::Vector3d(0, degrees * M_PI / 180, 0)));
  };
  for (int t = 0; t < motion.num_frames(); ++t) {
    motion.poses.block<1, 3>(t, 3 * kLeftHip) = rolled_by(t >= 150 && t < 160 ? 150 : 80).transpose();
    motion.poses(t, 3 * kSpine1) = t >= 300 && t < 305 ? 2.0 : 1.8;
  }
  MotionCleaningOptions options;
  options.max_joint_speed_m_s = 1e9;  // only what is broken shall show
  const CleanedMotion cleaned = CleanMotion(motion, options);
  EXPECT_EQ(cleaned.frames_broken, 15);
  EXPECT_EQ(cleaned.jumps, 0);
  ASSERT_EQ(cleaned.pieces.size(), 3);
  EXPECT_EQ(cleaned.pieces[0].num_frames(), 150 - 4);
}

TEST(MotionCleaning, ACrouchWithTheKneesApartIsSound) {
  Motion motion = StandingMotion(100, 2);
  for (int t = 0; t < motion.num_frames(); ++t) {  // thighs up to 140° forward and 60° out, shins folded
    const double part = t / 200.0;
    for (const double side : {1.0, -1.0}) {
      const Eigen::Matrix3d thigh = RotationFromAxisAngle(Eigen::Vector3d::UnitZ() * (side * M_PI / 3 * part)) *
                                    RotationFromAxisAngle(Eigen::Vector3d::UnitX() * (-140 * M_PI / 180 * part));
      motion.poses.block<1, 3>(t, 3 * (side > 0 ? kLeftHip : kLeftHip + 1)) = AxisAngleFromRotation(thigh).transpose();
    }
  }
  const CleanedMotion cleaned = CleanMotion(motion);
  EXPECT_EQ(cleaned.frames_broken, 0);
  ASSERT_EQ(cleaned.pieces.size(), 1);
}

TEST(MotionCleaning, AFootTurnedOverIsTurnedBackAndItsToesStay) {
  Motion motion = StandingMotion(100, 1);
  const Eigen::Vector3d foot = (SmplRestJoints().row(kLeftToe) - SmplRestJoints().row(kLeftAnkle)).transpose();
  const Eigen::Matrix3d bent = RotationFromAxisAngle(Eigen::Vector3d(0.3, 0.1, 0));
  const Eigen::Matrix3d over = bent * RotationFromAxisAngle(170 * M_PI / 180 * foot.normalized());
  motion.poses.block<1, 3>(40, 3 * kLeftAnkle) = AxisAngleFromRotation(over).transpose();
  const CleanedMotion cleaned = CleanMotion(motion);
  EXPECT_EQ(cleaned.frames_mended, 1);
  ASSERT_EQ(cleaned.pieces.size(), 1);
  EXPECT_LT(cleaned.pieces[0].poses.block(40, 3 * kLeftAnkle, 1, 3).norm(), 0.4);
  const MatrixX3d before = PoseSmplJoints(motion.poses.row(40).transpose(), Eigen::Vector3d::Zero());
  const MatrixX3d after = PoseSmplJoints(cleaned.pieces[0].poses.row(40).transpose(), Eigen::Vector3d::Zero());
  EXPECT_LT((before - after).norm(), 1e-12);
}

TEST(MotionCleaning, OneFrameAndWrongMotions) {
  EXPECT_TRUE(CleanMotion(StandingMotion(60, 0)).pieces.empty());
  Motion z_up = StandingMotion(60, 1);
  z_up.up = Motion::Up::kZ;
  EXPECT_THROW(CleanMotion(z_up), std::invalid_argument);
  Motion hands = StandingMotion(60, 1);
  hands.poses = RowMatrixXd::Zero(hands.num_frames(), 156);
  EXPECT_THROW(CleanMotion(hands), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::motion_cleaning_test
