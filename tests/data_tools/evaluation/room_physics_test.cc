// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/room_physics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "data_tools/body/builtin_body.h"
#include "geometry/base/units.h"
#include "geometry/body/centre_of_mass.h"
#include "geometry/body/posed_body.h"

namespace bodyloom::room_physics_test {
namespace {

constexpr double kFps = 50;

/// The built-in body as it was made, seen by a level camera 1.5 m above the ground, its lowest vertex `height` metres
/// over the ground and `along` metres to the right in each frame.
Track Placed(const std::vector<double>& height, const std::vector<double>& along = {}) {
  const BodyModel& body = BuiltinBody();
  const auto T = static_cast<Eigen::Index>(height.size());
  Track track;
  track.camera = MakePinhole(1280, 720, 1000);
  track.world = WorldOverGround(Eigen::Vector3d(0, -1, 0), 1.5);
  track.motion.body = body.name();
  track.motion.up = Motion::Up::kCamera;
  track.motion.betas = Eigen::VectorXd::Zero(body.num_betas());
  track.motion.poses.setZero(T, 3 * body.num_joints());
  track.motion.poses.col(0).setConstant(M_PI);  // upright in a camera whose y is down
  track.motion.trans.setZero(T, 3);
  BodyPose pose = PoseFromAxisAngle(body, track.motion.poses.row(0).transpose(), Eigen::Vector3d(0, 0, 4));
  const double lowest = PoseVertices(body, track.motion.betas, pose).col(1).maxCoeff();
  for (Eigen::Index t = 0; t < T; ++t) {
    track.motion.trans.row(t) << (along.empty() ? 0 : along[t]), 1.5 - lowest - height[t], 4;
    track.motion.timestamps.push_back(t / kFps);
    track.frame_status.push_back(FrameStatus::kTracked);
  }
  return track;
}

TEST(RoomPhysics, WhoStandsOnTheGroundDoesNothingWrong) {
  const RoomPhysics physics = MeasureRoomPhysics(Placed(std::vector<double>(100, 0.0)), BuiltinBody());
  EXPECT_EQ(physics.frames, 100);
  EXPECT_EQ(physics.hover_share, 0);
  EXPECT_EQ(physics.unexplained_hover_share, 0);
  EXPECT_NEAR(physics.lowest_point_m, 0, 1e-5);
  EXPECT_NEAR(physics.penetration_p95_m, 0, 1e-5);
  EXPECT_NEAR(physics.contact_slide_mps, 0, 1e-5);
  EXPECT_EQ(physics.BriefReport(),
            "on the ground or in flight in 100 % of the frames, within 0 mm below it in 95 %, contacts slide 0.00 m/s, "
            "off balance in 0 % of the slow frames, leans 3 deg on both feet");
}

TEST(RoomPhysics, WhoLeansIsOffBalance) {
  // Turned about the toes' edge by 20° the centre of mass, about 1 m up, is some 30 cm ahead of where it was.
  Track track = Placed(std::vector<double>(40, 0.0));
  const RoomPhysics upright = MeasureRoomPhysics(track, BuiltinBody());
  EXPECT_EQ(upright.balance_outside_share, 0);
  EXPECT_NEAR(upright.balance_p95_m, 0, 0.01);
  for (Eigen::Index t = 0; t < 40; ++t) {
    track.motion.poses.row(t).head<3>() << M_PI - 20 * kDegree, 0, 0;
    const BodyPose pose =
        PoseFromAxisAngle(BuiltinBody(), track.motion.poses.row(t).transpose(), track.motion.trans.row(t).transpose());
    const double lowest = PoseVertices(BuiltinBody(), track.motion.betas, pose).col(1).maxCoeff();
    track.motion.trans(t, 1) += 1.5 - lowest;
  }
  const RoomPhysics leaning = MeasureRoomPhysics(track, BuiltinBody());
  EXPECT_EQ(leaning.balance_outside_share, 1);
  EXPECT_GT(leaning.balance_p95_m, 0.15);
  EXPECT_LT(leaning.balance_p95_m, 0.4);
  EXPECT_NEAR(leaning.lean_median_deg, upright.lean_median_deg + 20, 8) << "the trunk's own line is not vertical";
}

TEST(RoomPhysics, WhoTouchesNothingHasNeitherBalanceNorLean) {
  const RoomPhysics physics = MeasureRoomPhysics(Placed(std::vector<double>(40, 0.3)), BuiltinBody());
  EXPECT_TRUE(std::isnan(physics.balance_outside_share));
  EXPECT_TRUE(std::isnan(physics.balance_p95_m));
  EXPECT_TRUE(std::isnan(physics.lean_median_deg));
}

TEST(RoomPhysics, HoveringAndPenetrationAreHeights) {
  std::vector<double> heights(100, 0.1);
  for (int t = 0; t < 40; ++t) heights[t] = -0.03;
  const RoomPhysics physics = MeasureRoomPhysics(Placed(heights), BuiltinBody());
  EXPECT_NEAR(physics.hover_share, 0.6, 1e-12);
  EXPECT_NEAR(physics.penetration_share, 0.4, 1e-12);
  EXPECT_NEAR(physics.penetration_p95_m, 0.03, 1e-5);
  EXPECT_NEAR(physics.lowest_point_m, 0.1, 1e-5);
  // Over 1.2 s a flight may rise by 1.8 m, so only the frames beside its ends are too high for one.
  EXPECT_NEAR(physics.unexplained_hover_share, 0.02, 0.011);
}

TEST(RoomPhysics, AJumpIsAFlight) {
  // A jump of 0.5 s and 31 cm between two stands, and a body that stays 20 cm up for as long as 0.2 s.
  std::vector<double> heights;
  for (int t = 0; t < 150; ++t) {
    const double s = t / kFps;
    heights.push_back(s > 1 && s < 1.5 ? 0.5 * 9.81 * (s - 1) * (1.5 - s) : s > 2 && s < 2.2 ? 0.2 : 0);
  }
  const RoomPhysics physics = MeasureRoomPhysics(Placed(heights), BuiltinBody());
  EXPECT_NEAR(physics.hover_share * 150, 24 - 2 + 9, 2.1) << "the flight's first and last centimetres are contact";
  EXPECT_NEAR(physics.unexplained_hover_share * 150, 9, 0.1) << "0.2 s lift by 5 cm at most";
  for (double& height : heights) height *= 1.5;  // no body falls that fast
  EXPECT_GT(MeasureRoomPhysics(Placed(heights), BuiltinBody()).unexplained_hover_share, 20.0 / 150);
}

TEST(RoomPhysics, AClipThatHoversThroughoutHasNoFlight) {
  EXPECT_GT(MeasureRoomPhysics(Placed(std::vector<double>(20, 0.3)), BuiltinBody()).unexplained_hover_share, 0.5);
}

TEST(RoomPhysics, SlidingIsTheSpeedOfWhatTouches) {
  std::vector<double> along;
  for (int t = 0; t < 50; ++t) along.push_back(0.4 * t / kFps);
  EXPECT_NEAR(MeasureRoomPhysics(Placed(std::vector<double>(50, 0.0), along), BuiltinBody()).contact_slide_mps, 0.4,
              1e-4);
  EXPECT_TRUE(
      std::isnan(MeasureRoomPhysics(Placed(std::vector<double>(50, 0.5), along), BuiltinBody()).contact_slide_mps));
}

constexpr double kBoxM = 0.45;

/// Stands on the floor for a second, then on a box for another one; `levels` says so.
Track OntoBox(bool levels) {
  std::vector<double> heights(100, 0.0);
  std::fill(heights.begin() + 50, heights.end(), kBoxM);
  Track track = Placed(heights);
  if (levels) track.level_m = Eigen::Map<const Eigen::VectorXd>(heights.data(), 100);
  return track;
}

TEST(RoomPhysics, WhoStandsOnABoxIsOnItsLevel) {
  const RoomPhysics ground_alone = MeasureRoomPhysics(OntoBox(false), BuiltinBody());
  EXPECT_EQ(ground_alone.hover_share, 0.5) << "every frame on the box";
  EXPECT_EQ(ground_alone.other_level_share, 0);
  const RoomPhysics levels = MeasureRoomPhysics(OntoBox(true), BuiltinBody());
  EXPECT_EQ(levels.hover_share, 0);
  EXPECT_EQ(levels.unexplained_hover_share, 0);
  EXPECT_EQ(levels.other_level_share, 0.5);
  EXPECT_NEAR(levels.penetration_p95_m, 0, 1e-5);
  EXPECT_EQ(levels.balance_outside_share, 0) << "the centre of mass does not jump with the level";
  EXPECT_NE(levels.BriefReport().find("in 95 %, on other levels in 50 %, contacts"), std::string::npos);
  Track deeper = OntoBox(true);
  deeper.level_m.tail(50).array() += 0.1;
  EXPECT_NEAR(MeasureRoomPhysics(deeper, BuiltinBody()).penetration_p95_m, 0, 1e-5)
      << "within a second of the step, what is above the floor may be beside the box";
  deeper.level_m.setConstant(0.1);
  EXPECT_NEAR(MeasureRoomPhysics(deeper, BuiltinBody()).penetration_p95_m, 0.1, 1e-5);
}

TEST(RoomPhysics, AJumpOntoABoxIsAFlight) {
  // Off the floor at 1 s, 8 cm over the box at the highest, on it 0.46 s later; until then on the level of the floor.
  const double up_mps = std::sqrt(2 * kGravity * (kBoxM + 0.08)),
               lands_s = 1 + (up_mps + std::sqrt(2 * kGravity * 0.08)) / kGravity;
  std::vector<double> heights, levels;
  for (int t = 0; t < 100; ++t) {
    const double s = t / kFps - 1;
    const bool lands = t / kFps >= lands_s;
    heights.push_back(s <= 0 ? 0 : lands ? kBoxM : up_mps * s - 0.5 * kGravity * s * s);
    levels.push_back(lands ? kBoxM : 0);
  }
  Track track = Placed(heights);
  track.level_m = Eigen::Map<const Eigen::VectorXd>(levels.data(), 100);
  const RoomPhysics physics = MeasureRoomPhysics(track, BuiltinBody());
  EXPECT_GT(physics.hover_share, 0.15);
  EXPECT_EQ(physics.unexplained_hover_share, 0);
  for (int t = 55; t < 70; ++t) track.motion.trans(t, 1) -= 0.15;
  EXPECT_GT(MeasureRoomPhysics(track, BuiltinBody()).unexplained_hover_share, 0.1);
}

TEST(RoomPhysics, AFootOnTheBoxSupportsTheStep) {
  // The left foot is drawn up flat, by bent hip, knee and ankle; while it is on the box the right one hangs beside it.
  const BodyModel& body = BuiltinBody();
  for (const bool box_begins : {false, true}) {
    Track track = OntoBox(true);
    double drawn_up_m = 0;
    for (int t = 40; t < 50; ++t) {
      for (const auto& [joint, angle] : {std::pair("l_hip", -0.6), {"l_knee", 1.2}, {"l_ankle", -0.6}}) {
        track.motion.poses(t, 3 * body.FindJoint(joint)) = angle;
      }
      const BodyPose pose = PoseFromAxisAngle(body, track.motion.poses.row(t).transpose(), Eigen::Vector3d(0, 0, 4));
      const MatrixX3d joints = PoseSkeleton(body, body.RestJoints(track.motion.betas), pose).joints;
      drawn_up_m = joints(body.FindJoint("r_ankle"), 1) - joints(body.FindJoint("l_ankle"), 1);
      track.motion.trans(t, 1) -= kBoxM - drawn_up_m;
      track.level_m[t] = box_begins ? kBoxM : 0;
    }
    ASSERT_GT(drawn_up_m, 0.1);
    const RoomPhysics physics = MeasureRoomPhysics(track, body);
    EXPECT_EQ(physics.hover_share, 0) << box_begins;
    EXPECT_EQ(physics.penetration_share, 0) << box_begins;
    Track no_box = track;
    no_box.level_m.resize(0);
    EXPECT_EQ(MeasureRoomPhysics(no_box, body).hover_share, 0.6);
    for (int t = 40; t < 50; ++t) track.motion.trans(t, 1) -= 0.1;
    if (box_begins) continue;
    EXPECT_EQ(MeasureRoomPhysics(track, body).hover_share, 0.1) << "neither foot is on anything";
  }
}

TEST(RoomPhysics, LostFramesAreLeftOutAndNeedsAWorld) {
  Track track = Placed(std::vector<double>(30, 0.0));
  track.motion.poses.row(4).setConstant(std::nan(""));
  for (const int threads : {1, 3}) EXPECT_EQ(MeasureRoomPhysics(track, BuiltinBody(), threads).frames, 29);
  track.motion.poses.setConstant(std::nan(""));
  EXPECT_TRUE(std::isnan(MeasureRoomPhysics(track, BuiltinBody()).hover_share));
  EXPECT_EQ(MeasureRoomPhysics(track, BuiltinBody()).BriefReport(), "");
  track.world.reset();
  EXPECT_THROW(MeasureRoomPhysics(track, BuiltinBody()), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::room_physics_test
