// SPDX-License-Identifier: Apache-2.0
#include "geometry/scene/camera_path.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "geometry/math/rotation.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::camera_path_test {
namespace {

using Eigen::Vector3d;

CameraPose PoseOf(const Vector3d& turn, const Vector3d& translation) {
  return {RotationFromAxisAngle(turn), translation};
}

const CameraPose kFirst = PoseOf({0.3, -0.2, 0.1}, {1, 2, 3}), kSecond = PoseOf({-0.1, 0.4, 0.2}, {0.5, -1, 4});

TEST(CameraPath, PosesComposeAndInvert) {
  const Vector3d x(0.3, -0.7, 2);
  EXPECT_TRUE(MovedPoint(Compose(kSecond, kFirst), x).isApprox(MovedPoint(kSecond, MovedPoint(kFirst, x)), 1e-14));
  EXPECT_TRUE(MovedPoint(Inverse(kFirst), MovedPoint(kFirst, x)).isApprox(x, 1e-14));
  EXPECT_LT(MovedPoint(kFirst, CentreOf(kFirst)).norm(), 1e-14);
  const MatrixX3d rows = (MatrixX3d(2, 3) << 0.3, -0.7, 2, 1, 1, 1).finished();
  EXPECT_TRUE(MovedPoints(kFirst, rows).row(0).transpose().isApprox(MovedPoint(kFirst, x), 1e-14));
}

TEST(CameraPath, AMovedPoseMovesEveryVertex) {
  const BodyModel body(ToyBodyData());
  const Eigen::VectorXd betas = Eigen::VectorXd::Constant(body.num_betas(), 0.4);
  std::mt19937_64 random(3);
  BodyPose pose;
  for (int j = 0; j < body.num_joints(); ++j) {
    pose.rotations.push_back(
        RotationFromAxisAngle(0.3 * Vector3d::NullaryExpr([&] { return std::normal_distribution<double>()(random); })));
  }
  pose.trans = {0.1, -0.2, 3};
  const Vector3d pelvis = body.RestJoints(betas).row(0).transpose();
  const MatrixX3d moved = PoseVertices(body, betas, MovedPose(kFirst, pelvis, pose));
  EXPECT_LT((moved - MovedPoints(kFirst, PoseVertices(body, betas, pose))).norm(), 1e-12);

  Motion motion;
  motion.poses = AxisAngleFromPose(body, pose).transpose().replicate(2, 1);
  motion.trans = pose.trans.transpose().replicate(2, 1);
  motion.betas = betas;
  motion.timestamps = {0, 1};
  const std::vector<CameraPose> each = {kFirst, kSecond};
  const Motion seen = MovedMotion(body, motion, each);
  for (int t = 0; t < 2; ++t) {
    const BodyPose own = PoseFromAxisAngle(body, seen.poses.row(t).transpose(), seen.trans.row(t).transpose());
    const MatrixX3d expected = MovedPoints(each[size_t(t)], PoseVertices(body, betas, pose));
    EXPECT_LT((PoseVertices(body, betas, own) - expected).norm(), 1e-9);
  }
  EXPECT_THROW(MovedMotion(body, motion, std::vector<CameraPose>(3)), std::invalid_argument);
}

TEST(CameraPath, TheSceneIsTheFrameOfItsFirstPose) {
  const CameraPath path{{0, 1}, {kFirst, kSecond}};
  const SampledCameraPath sampled = SampleCameraPath(path, std::vector<double>{0, 1});
  EXPECT_TRUE(sampled.camera_from_scene[0].camera_from_world_rotation.isIdentity(1e-14));
  EXPECT_LT(sampled.camera_from_scene[0].camera_from_world_translation.norm(), 1e-14);
  // A point of the world, told in the scene, is where the second camera saw it.
  const Vector3d in_world(0.2, 0.4, 1), in_scene = MovedPoint(kFirst, in_world);
  EXPECT_LT((MovedPoint(sampled.camera_from_scene[1], in_scene) - MovedPoint(kSecond, in_world)).norm(), 1e-13);
  EXPECT_EQ(sampled.interpolated, 0);
  EXPECT_EQ(sampled.beyond, 0);
}

TEST(CameraPath, BetweenPosesTheCentreGoesStraightAndTheCameraTurnsEvenly) {
  const CameraPath path{{0, 0.5}, {CameraPose(), kSecond}};
  const SampledCameraPath sampled = SampleCameraPath(path, std::vector<double>{0, 0.25, 0.5});
  EXPECT_EQ(sampled.interpolated, 1);
  EXPECT_LT((CentreOf(sampled.camera_from_scene[1]) - 0.5 * CentreOf(kSecond)).norm(), 1e-12);
  EXPECT_NEAR(RotationAngleBetween(sampled.camera_from_scene[0].camera_from_world_rotation,
                                   sampled.camera_from_scene[1].camera_from_world_rotation),
              0.5 * AxisAngleFromRotation(kSecond.camera_from_world_rotation).norm(), 1e-9);
}

TEST(CameraPath, RefusesWhatItDoesNotKnow) {
  const CameraPath path{{0, 0.5, 3}, {kFirst, kSecond, kFirst}};
  const auto message_of = [&](const CameraPath& of, double t) -> std::string {
    try {
      SampleCameraPath(of, std::vector<double>{t});
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message_of(path, -0.05), "");
  EXPECT_THAT(message_of(path, -0.2), testing::HasSubstr("-0.2 s; its path goes from 0 to 3"));
  EXPECT_THAT(message_of(path, 3.2), testing::HasSubstr("3.2 s"));
  EXPECT_THAT(message_of(path, 1), testing::HasSubstr("from 0.5 to 3 s"));
  EXPECT_EQ(message_of(path, 3), "");
  EXPECT_EQ(message_of(path, 0.5), "");
  EXPECT_THAT(message_of({{1, 1}, {kFirst, kFirst}}, 1), testing::HasSubstr("rising"));
  EXPECT_THAT(message_of({{}, {}}, 1), testing::HasSubstr("at least one"));
  EXPECT_EQ(SampleCameraPath(path, std::vector<double>{-0.05, 3.05}).beyond, 2);
}

TEST(CameraPath, ATrackInItsCamerasIsWhatTheySaw) {
  const BodyModel body(ToyBodyData());
  Track track;
  track.motion.poses = RowMatrixXd::Zero(2, 3 * body.num_joints());
  track.motion.trans = (MatrixX3d(2, 3) << 0, 0, 3, 0.1, 0, 3).finished();
  track.motion.betas = Eigen::VectorXd::Zero(body.num_betas());
  track.motion.timestamps = {0, 1};
  track.joints = {MatrixX3d::Constant(2, 3, 1.0), MatrixX3d::Constant(2, 3, 2.0)};
  const Track same = TrackInCameras(body, track);
  EXPECT_EQ(same.motion.trans, track.motion.trans);
  track.camera_from_scene = {kFirst, kSecond};
  const Track seen = TrackInCameras(body, track);
  EXPECT_FALSE(seen.HasMovingCamera());
  EXPECT_TRUE(seen.joints[1].row(0).transpose().isApprox(MovedPoint(kSecond, Vector3d::Constant(2)), 1e-13));
  const Vector3d pelvis = body.RestJoints(track.motion.betas).row(0).transpose();
  EXPECT_TRUE((seen.motion.trans.row(1).transpose() + pelvis)
                  .isApprox(MovedPoint(kSecond, pelvis + Vector3d(0.1, 0, 3)), 1e-13));
}

}  // namespace
}  // namespace bodyloom::camera_path_test
