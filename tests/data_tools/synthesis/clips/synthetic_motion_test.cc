// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "data_tools/body/builtin_body.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/smooth_curve.h"
#include "data_tools/synthesis/clips/synth_camera.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "tests/support/toy_body.h"

namespace bodyloom::synthetic_motion_test {
namespace {

using Eigen::Vector3d;

BodyPose PoseAt(const BodyModel& body, const Motion& motion, int t) {
  return PoseFromAxisAngle(body, motion.poses.row(t).transpose(), motion.trans.row(t).transpose());
}

TEST(SmoothCurve, StaysInTheRangeOfItsKeysAndIsSmooth) {
  const SmoothCurve curve({{0, 1}, {1, 3}, {2, -1}});
  double largest_jump = 0;
  for (double t = -1; t < 3; t += 1e-3) {
    EXPECT_LE(curve(t), 3 + 1e-12);
    EXPECT_GE(curve(t), -1 - 1e-12);
    const double second = (curve(t + 1e-3) - 2 * curve(t) + curve(t - 1e-3)) / 1e-6;
    largest_jump = std::max(largest_jump, std::abs(second));
  }
  EXPECT_NEAR(curve(-0.5), 1, 1e-12);
  EXPECT_NEAR(curve(2.5), -1, 1e-12);
  EXPECT_NEAR(curve(0.5), 2, 1e-9);
  EXPECT_LT(largest_jump, 100) << "a corner would show 1/step = 1000s";
  EXPECT_NEAR(SmoothStep(0.5), 0.5, 1e-15);
  EXPECT_EQ(SmoothStep(-1), 0);
  EXPECT_EQ(SmoothStep(2), 1);
}

class DemoMotionOfBody : public testing::TestWithParam<const BodyModel* (*)()> {};

TEST_P(DemoMotionOfBody, FeetStandOnTheFloorAndDoNotSlide) {
  const BodyModel& body = *GetParam()();
  const Motion motion = DemoMotion(body, 360, 60);
  const double floor = body.data().v_template.col(1).minCoeff();
  const double stature = body.data().v_template.col(1).maxCoeff() - floor;
  double worst_slide = 0;
  int standing = 0;
  for (const std::string side : {"left_", "right_"}) {
    const std::vector<std::string> toe = {side + "big_toe"};
    const BodyPose rest = PoseFromAxisAngle(body, Eigen::VectorXd::Zero(72), Vector3d::Zero());
    const double toe_height = PoseLandmarks(body, Eigen::VectorXd(), rest, toe)(0, 1) - floor;
    Vector3d last = Vector3d::Zero();
    bool was_down = false;
    for (int t = 0; t < motion.num_frames(); ++t) {
      const Vector3d now = PoseLandmarks(body, Eigen::VectorXd(), PoseAt(body, motion, t), toe).row(0);
      const bool is_down = now.y() < toe_height + 0.002 * stature;
      if (is_down && was_down) {
        worst_slide = std::max(worst_slide, std::hypot(now.x() - last.x(), now.z() - last.z()));
        ++standing;
      }
      last = now;
      was_down = is_down;
    }
  }
  EXPECT_GT(standing, 400);
  EXPECT_LT(worst_slide, 0.007) << "metres a frame at 60 fps";
  for (int t = 0; t < motion.num_frames(); t += 12) {
    const double lowest = PoseVertices(body, Eigen::VectorXd(), PoseAt(body, motion, t)).col(1).minCoeff();
    EXPECT_GT(lowest, -0.03 * stature) << "frame " << t << ": through the floor";
    EXPECT_LT(lowest, 0.02 * stature) << "frame " << t << ": floating";
  }
}

TEST_P(DemoMotionOfBody, IsSmoothAndKeepsWithinHumanLimits) {
  const BodyModel& body = *GetParam()();
  const double fps = 240;
  const Motion motion = DemoMotion(body, static_cast<int>(kDemoMotionSeconds * fps), fps);
  std::vector<BodyPose> poses;
  poses.reserve(static_cast<size_t>(motion.num_frames()));
  for (int t = 0; t < motion.num_frames(); ++t) poses.push_back(PoseAt(body, motion, t));
  double fastest = 0, hardest = 0;
  for (int t = 1; t + 1 < motion.num_frames(); ++t) {
    for (int j = 0; j < 24; ++j) {
      const Vector3d before = AxisAngleFromRotation(poses[t - 1].rotations[j].transpose() * poses[t].rotations[j]);
      const Vector3d after = AxisAngleFromRotation(poses[t].rotations[j].transpose() * poses[t + 1].rotations[j]);
      fastest = std::max(fastest, after.norm() * fps);
      hardest = std::max(hardest, (after - before).norm() * fps * fps);
    }
    for (const int knee : {4, 5}) {
      const Vector3d bend = AxisAngleFromRotation(poses[t].rotations[knee]);
      EXPECT_GT(bend.x(), -0.12) << "a knee bends backwards in frame " << t;
      EXPECT_LT(bend.x(), 2.5) << "frame " << t;
    }
  }
  EXPECT_LT(fastest, 18) << "rad/s";
  EXPECT_LT(hardest, 600) << "rad/s²: a jump of a degree in one frame would be 1000";
}

TEST_P(DemoMotionOfBody, WalksTurnsWavesAndKicks) {
  const BodyModel& body = *GetParam()();
  const Motion motion = DemoMotion(body, 180, 30);
  const MatrixX3d rest = body.RestJoints(Eigen::VectorXd());
  std::vector<MatrixX3d> joints;
  joints.reserve(180);
  for (int t = 0; t < 180; ++t) joints.push_back(PoseSkeleton(body, rest, PoseAt(body, motion, t)).joints);
  const double leg = (rest.row(1) - rest.row(7)).norm();
  EXPECT_GT((joints[0].row(0) - joints[100].row(0)).norm(), 1.8 * leg) << "walks";
  const auto front = [&](int t) { return Vector3d(PoseAt(body, motion, t).rotations[0] * Vector3d::UnitZ()); };
  EXPECT_LT(front(0).dot(front(100)), 0.5) << "turns";
  EXPECT_GT(front(100).z(), 0.95) << "faces the viewer";
  for (const int t : {105, 115, 125})
    EXPECT_GT(joints[t](21, 1), joints[t](15, 1)) << "waves: the right wrist is above the head's joint";
  double highest_ankle = 0;
  for (int t = 140; t < 180; ++t) highest_ankle = std::max(highest_ankle, joints[t](8, 1));
  EXPECT_GT(highest_ankle, 0.7 * leg) << "kicks";
  EXPECT_LT((joints[179].row(8) - joints[130].row(8)).norm(), 0.01) << "puts the foot back";
}

INSTANTIATE_TEST_SUITE_P(Bodies, DemoMotionOfBody,
                         testing::Values(
                             +[] { return &ToyBody(); }, +[] { return &BuiltinBody(); }));

TEST(DemoMotion, PlaysThereAndBackForLongClips) {
  const Motion motion = DemoMotion(ToyBody(), 500, 30);
  EXPECT_EQ(motion.num_frames(), 500);
  EXPECT_LT((motion.poses.row(180 + 40) - motion.poses.row(180 - 40)).norm(), 1e-9);
  EXPECT_LT((motion.poses.row(360 + 25) - motion.poses.row(25)).norm(), 1e-9);
  EXPECT_NEAR(motion.timestamps[499], 499 / 30.0, 1e-12);
  EXPECT_EQ(DemoMotion(ToyBody(), 90, 15).poses.row(30), DemoMotion(ToyBody(), 180, 30).poses.row(60));
}

TEST(DemoMotion, RefusesOtherSkeletons) {
  EXPECT_THROW(DemoMotion(ToyBody(), 0, 30), std::invalid_argument);
  EXPECT_THROW(DemoMotion(ToyBody(), 10, 0), std::invalid_argument);
  BodyModelData data = ToyBodyData();
  data.parents[21] = 18;
  EXPECT_THROW(DemoMotion(BodyModel(std::move(data)), 10, 30), std::invalid_argument);
}

TEST(SynthCamera, HoldsTheWholeClipAndFillsTheImage) {
  const Motion motion = DemoMotion(ToyBody(), 60, 10);
  for (const CameraModel model : {CameraModel::kPinhole, CameraModel::kWeakPerspective}) {
    for (const double yaw : {0.0, 140.0}) {
      SynthCameraOptions options;
      options.model = model;
      options.yaw_deg = yaw;
      options.elevation_deg = 12;
      const SynthCamera placed = PlaceSynthCamera(ToyBody(), motion, options);
      const Motion seen = MotionInCamera(ToyBody(), motion, placed.pose);
      Eigen::AlignedBox2d box;
      for (int t = 0; t < motion.num_frames(); ++t) {
        const MatrixX3d vertices = PoseVertices(ToyBody(), Eigen::VectorXd(), PoseAt(ToyBody(), seen, t));
        for (int v = 0; v < vertices.rows(); ++v) {
          Eigen::Vector2d pixel;
          ASSERT_TRUE(placed.camera.Project(vertices.row(v), &pixel));
          box.extend(pixel);
        }
      }
      EXPECT_GE(box.min().minCoeff(), 0);
      EXPECT_LT(box.max().x(), options.width);
      EXPECT_LT(box.max().y(), options.height);
      const double share = std::max(box.sizes().x() / options.width, box.sizes().y() / options.height);
      EXPECT_NEAR(share, options.fill, 0.06) << ToString(model) << " " << yaw;
      EXPECT_LT(placed.up_in_camera.y(), -0.9);
    }
  }
}

TEST(SynthCamera, YawAndElevationAreWhereTheySay) {
  const Motion motion = DemoMotion(ToyBody(), 20, 10);
  SynthCameraOptions options;
  options.yaw_deg = 90;
  options.elevation_deg = 30;
  const SynthCamera placed = PlaceSynthCamera(ToyBody(), motion, options);
  const Vector3d camera_in_world =
      -placed.pose.camera_from_world_rotation.transpose() * placed.pose.camera_from_world_translation;
  EXPECT_GT(camera_in_world.x(), 1) << "yaw 90 stands on +x";
  EXPECT_GT(camera_in_world.y(), 1.5) << "from above";
}

TEST(SynthCamera, TheBodyStaysTheSameInTheCameraFrame) {
  const Motion motion = DemoMotion(ToyBody(), 30, 10);
  const SynthCamera placed = PlaceSynthCamera(ToyBody(), motion, {});
  const Motion seen = MotionInCamera(ToyBody(), motion, placed.pose);
  for (const int t : {0, 14, 29}) {
    const MatrixX3d world = PoseVertices(ToyBody(), Eigen::VectorXd(), PoseAt(ToyBody(), motion, t));
    const MatrixX3d camera = PoseVertices(ToyBody(), Eigen::VectorXd(), PoseAt(ToyBody(), seen, t));
    const MatrixX3d expected = (world * placed.pose.camera_from_world_rotation.transpose()).rowwise() +
                               placed.pose.camera_from_world_translation.transpose();
    EXPECT_LT((camera - expected).cwiseAbs().maxCoeff(), 1e-9) << "the toy's pelvis is not its origin";
  }
}

TEST(SynthCamera, KnowsWorldsWithZUp) {
  Motion motion = DemoMotion(ToyBody(), 20, 10);
  const SynthCamera expected = PlaceSynthCamera(ToyBody(), motion, {});
  // The same motion in a world with z up: y up → z up is a quarter turn about x.
  const Eigen::Matrix3d z_up_from_y_up = RotationFromAxisAngle(Vector3d(M_PI / 2, 0, 0));
  Motion turned = MotionInCamera(ToyBody(), motion, {z_up_from_y_up, Vector3d::Zero()});
  turned.up = Motion::Up::kZ;
  const SynthCamera placed = PlaceSynthCamera(ToyBody(), turned, {});
  EXPECT_LT((placed.pose.camera_from_world_rotation * z_up_from_y_up - expected.pose.camera_from_world_rotation).norm(),
            1e-9);
  EXPECT_LT((placed.pose.camera_from_world_translation - expected.pose.camera_from_world_translation).norm(), 1e-6);
}

}  // namespace
}  // namespace bodyloom::synthetic_motion_test
