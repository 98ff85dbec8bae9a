// SPDX-License-Identifier: Apache-2.0
#include "geometry/scene/rig.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "data_tools/body/builtin_body.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "geometry/scene/track.h"
#include "tests/support/short_track.h"

namespace bodyloom::rig_test {
namespace {

RigCamera Other() {
  RigCamera camera;
  camera.camera = MakePinhole(640, 480, 700);
  camera.camera_from_rig = {RotationFromAxisAngle(Eigen::Vector3d(0.1, 1.2, -0.2)), Eigen::Vector3d(-2, 0.3, 1.5)};
  camera.offset_s = 0.25;
  camera.rate = 1e-3;
  camera.middle_s = 1;
  return camera;
}

Track Seen() {
  SynthClipOptions options;
  options.dense_per_frame = 0;
  Track track = MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 8, 30), options).truth;
  track.world = WorldOverGround(Eigen::Vector3d(0.1, -1, 0.2), 1.4);
  return track;
}

TEST(RigCamera, TimesGoThereAndBack) {
  const RigCamera camera = Other();
  EXPECT_DOUBLE_EQ(camera.TimeAt(1), 1.25);
  EXPECT_NEAR(camera.TimeAt(11), 11.26, 1e-12);
  EXPECT_NEAR(camera.FirstTimeAt(camera.TimeAt(3.7)), 3.7, 1e-12);
}

TEST(TrackSeenBy, MovesPosesJointsClockAndWorldToTheOtherCamera) {
  const Track track = Seen();
  const RigCamera camera = Other();
  const Track seen = TrackSeenBy(camera, BuiltinBody(), track);
  ASSERT_EQ(seen.num_frames(), track.num_frames());
  EXPECT_FALSE(seen.HasMovingCamera());
  EXPECT_EQ(seen.camera.fx, 700);
  for (const int t : {0, 5}) {
    EXPECT_NEAR(seen.motion.timestamps[size_t(t)], camera.TimeAt(track.motion.timestamps[size_t(t)]), 1e-12);
    const MatrixX3d moved = MovedPoints(camera.camera_from_rig, track.joints[size_t(t)]);
    EXPECT_LT((seen.joints[size_t(t)] - moved).cwiseAbs().maxCoeff(), 1e-12);
    const BodyPose pose =
        PoseFromAxisAngle(BuiltinBody(), seen.motion.poses.row(t).transpose(), seen.motion.trans.row(t).transpose());
    EXPECT_LT((PoseSkeleton(BuiltinBody(), BuiltinBody().RestJoints(seen.motion.betas), pose).joints - moved)
                  .cwiseAbs()
                  .maxCoeff(),
              1e-6)
        << "the pose says the same as the joints";
    // The place of a joint in the world does not depend on who saw it.
    EXPECT_LT(
        (seen.world->PointsFromCamera(seen.joints[size_t(t)]) - track.world->PointsFromCamera(track.joints[size_t(t)]))
            .cwiseAbs()
            .maxCoeff(),
        1e-12);
  }
}

TEST(TrackSeenBy, AMovingCameraIsRefused) {
  Track track = Seen();
  track.camera_from_scene.resize(size_t(track.num_frames()));
  EXPECT_THROW(TrackSeenBy(Other(), BuiltinBody(), track), std::invalid_argument);
}

TEST(WithStillCamera, TheMotionIsWhereItWasInTheWorld) {
  Track moving = ShortTrack(6, SynthCameraMotion::kOrbit);
  ASSERT_TRUE(moving.HasMovingCamera());
  moving.world.emplace();
  moving.world->rotation = RotationFromAxisAngle(Eigen::Vector3d(M_PI, 0.1, 0));
  moving.world->translation = Eigen::Vector3d(0.2, 1.4, -0.3);
  const Track still = WithStillCamera(BuiltinBody(), moving), in_cameras = TrackInCameras(BuiltinBody(), moving);
  EXPECT_FALSE(still.HasMovingCamera());
  EXPECT_EQ(still.motion.timestamps, moving.motion.timestamps);
  EXPECT_LT((still.joints[0] - in_cameras.joints[0]).cwiseAbs().maxCoeff(), 1e-9) << "where the camera began";
  EXPECT_GT((still.joints.back() - in_cameras.joints.back()).cwiseAbs().maxCoeff(), 0.05);
  ASSERT_TRUE(still.world);
  for (size_t t = 0; t < still.joints.size(); ++t) {
    const MatrixX3d expected = moving.world->PointsFromCamera(moving.joints[t]);
    EXPECT_LT((still.world->PointsFromCamera(still.joints[t]) - expected).cwiseAbs().maxCoeff(), 1e-9);
  }
  const Track same = WithStillCamera(BuiltinBody(), Seen());
  EXPECT_EQ(same.motion.poses, Seen().motion.poses);
  EXPECT_EQ(same.camera.fx, Seen().camera.fx);
}

}  // namespace
}  // namespace bodyloom::rig_test
