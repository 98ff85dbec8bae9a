// SPDX-License-Identifier: Apache-2.0
// Rotations at and beyond half a turn, and distant initial values.
#include <cmath>

#include "data_tools/body/builtin_body.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "geometry/math/rotation.h"
#include "tests/stress/stress_support.h"

namespace bodyloom::stress::rotations_test {
namespace {

class Rotations : public EngineTest {};
BODYLOOM_WITH_EVERY_ENGINE(Rotations);

constexpr double kDegree = M_PI / 180;

// Whoever faces the camera has a root rotation of exactly half a turn (y down against y up), about an axis that moves
// with the heading; from behind it is half a turn about another axis.
TEST_P(Rotations, EveryHeadingIsFoundAndTheRootNeverJumps) {
  for (int heading_deg = 0; heading_deg < 360; heading_deg += 45) {
    SynthClipOptions options;
    options.camera.yaw_deg = heading_deg;
    const SynthClip clip = DemoClip(BuiltinBody(), 30, 15, 0, options);
    const TrackSequenceResult result = Fit(InputOf(BuiltinBody(), clip), OptionsOf(GetParam()));
    ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
    EXPECT_LT(ErrorMm(result, clip), 90) << heading_deg;
    EXPECT_LT(RootErrorRad(result, clip, 15), 45 * kDegree) << heading_deg;
    EXPECT_LT(LargestStep(result.track), 30 * kDegree) << heading_deg;
  }
}

TEST_P(Rotations, TwoTurnsOnTheSpot) {
  Motion motion = DemoMotion(BuiltinBody(), 60, 15);
  for (int t = 0; t < 60; ++t) {
    motion.poses.row(t) = motion.poses.row(0);
    motion.trans.row(t) = motion.trans.row(0);
    const Eigen::Matrix3d turn = RotationFromAxisAngle(Eigen::Vector3d(0, t * 720.0 / 60 * kDegree, 0));
    const Eigen::Matrix3d root = RotationFromAxisAngle(motion.poses.row(0).head<3>().transpose());
    motion.poses.row(t).head<3>() = AxisAngleFromRotation(turn * root).transpose();
  }
  const SynthClip clip = ClipOf(BuiltinBody(), motion);
  const TrackSequenceResult result = Fit(InputOf(BuiltinBody(), clip), OptionsOf(GetParam()));
  ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
  EXPECT_LT(ErrorMm(result, clip), 90);
  EXPECT_LT(LargestStep(result.track), 45 * kDegree);  // 12° a frame
}

TEST_P(Rotations, AnAngleBeyondATurnIsTheSameStart) {
  const SynthClip clip = DemoClip(BuiltinBody(), 12, 15, 100);
  const Motion start = clip.truth.motion;
  TrackSequenceInput input = InputOf(BuiltinBody(), clip);
  input.initialiser = &start;
  const TrackSequenceResult expected = Fit(input, OptionsOf(GetParam()));
  for (const int turns : {-1, 1, 5}) {
    Motion wound = start;
    for (int t = 0; t < wound.num_frames(); ++t) {
      for (int j = 0; j < BuiltinBody().num_joints(); ++j) {
        const Eigen::Vector3d w = wound.poses.row(t).segment<3>(3 * j).transpose();
        if (w.norm() < 1e-3) continue;
        wound.poses.row(t).segment<3>(3 * j) = (w * (1 + turns * 2 * M_PI / w.norm())).transpose();
      }
    }
    input.initialiser = &wound;
    const TrackSequenceResult result = Fit(input, OptionsOf(GetParam()));
    ASSERT_TRUE(result.summary.IsUsable());
    EXPECT_LT(LargestDifference(result.track, expected.track), 1e-3) << turns;
  }
}

// Dense keypoints see which way the person faces, so the start need not. Beyond these, see docs/lab/convergence.md:
// 120° about the viewing axis ends in another basin.
TEST_P(Rotations, StartsTurnedFarOffTheTruthComeBackWithDenseKeypoints) {
  const SynthClip clip = DemoClip(BuiltinBody(), 8, 15, 150);
  struct Start {
    double off_deg;
    int axis;  ///< of the camera frame
    double mm;
  };
  for (const Start& from :
       {Start{90, 0, 10}, Start{90, 1, 10}, Start{90, 2, 10}, Start{120, 0, 40}, Start{120, 1, 40}}) {
    Motion start = clip.truth.motion;
    const Eigen::Matrix3d turn = RotationFromAxisAngle(from.off_deg * kDegree * Eigen::Vector3d::Unit(from.axis));
    for (int t = 0; t < start.num_frames(); ++t) {
      const Eigen::Matrix3d root = RotationFromAxisAngle(start.poses.row(t).head<3>().transpose());
      start.poses.row(t).head<3>() = AxisAngleFromRotation(turn * root).transpose();
    }
    TrackSequenceInput input = InputOf(BuiltinBody(), clip);
    input.initialiser = &start;
    TrackSequenceOptions options = OptionsOf(GetParam());
    options.initialiser_weight = 0;
    const TrackSequenceResult result = Fit(input, options);
    ASSERT_TRUE(result.summary.IsUsable());
    EXPECT_LT(ErrorMm(result, clip), from.mm) << from.off_deg << " degrees about axis " << from.axis;
  }
}

}  // namespace
}  // namespace bodyloom::stress::rotations_test
