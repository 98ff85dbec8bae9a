// SPDX-License-Identifier: Apache-2.0
#include "tracking/room/shared_scene.h"

#include <gtest/gtest.h>

namespace bodyloom::track_world_test {
namespace {

std::vector<MatrixX3d> OneFrame() { return {(MatrixX3d(1, 3) << 0, 1, 3).finished()}; }

TEST(TrackWorld, SaysHowItWasFound) {
  GroundSummary ground;
  EXPECT_EQ(WorldOfGround(ground, OneFrame()).source, WorldSource::kLevelCamera);
  EXPECT_NEAR(WorldOfGround(ground, OneFrame()).camera_height_m(), 1.04, 1e-9);

  ground.has_up = true;
  ground.up = Eigen::Vector3d(0, -1, -0.1).normalized();
  ground.up_sigma_deg = 4;
  WorldFrame world = WorldOfGround(ground, OneFrame());
  EXPECT_EQ(world.source, WorldSource::kVertical);
  EXPECT_EQ(world.vertical_sigma_deg, 4);
  EXPECT_NEAR(world.PointFromCamera({0, 1, 3}).y(), 0.04, 1e-9);

  ground.has_plane = true;
  ground.camera_height_m = 1.7;
  ground.height_sigma_m = 0.02;
  world = WorldOfGround(ground, OneFrame());
  EXPECT_EQ(world.source, WorldSource::kGround);
  EXPECT_EQ(world.camera_height_m(), 1.7);
  EXPECT_EQ(world.height_sigma_m, 0.02);
  EXPECT_TRUE(world.up_in_camera().isApprox(ground.up, 1e-12));
  ground.given = true;
  EXPECT_EQ(WorldOfGround(ground, OneFrame()).source, WorldSource::kGiven);
}

/// Somebody whose fit found the vertical and who stands on the plane 1.5 m under a level camera.
TrackSequenceSummary Standing(double x) {
  TrackSequenceSummary person;
  person.status = SolveStatus::kConverged;
  person.frames_by_status["tracked"] = 100;
  person.ground.has_up = person.ground.has_plane = true;
  person.ground.camera_height_m = 1.5;
  person.ground.up_sigma_deg = 3;
  person.ground.height_sigma_m = 0.05;
  for (int i = 0; i < 6; ++i) {
    person.ground.stances.push_back({.foot = i % 2,
                                     .begin = 10 * i,
                                     .end = 10 * i + 10,
                                     .seconds = 0.4,
                                     .place_m = {x + 0.3 * (i % 3), 1.5, 3 + 0.4 * i}});
  }
  return person;
}

TEST(TrackWorld, PeopleShareOne) {
  const SharedScene scene = JoinScenes({Standing(-1), Standing(1)}, FocalPrior::ForImage(1280, 720));
  const WorldFrame world = WorldOfScene(scene, OneFrame());
  EXPECT_EQ(world.source, WorldSource::kPeople);
  EXPECT_NEAR(world.camera_height_m(), 1.5, 1e-3);
  EXPECT_GT(world.vertical_sigma_deg, 0);
  EXPECT_LT(world.vertical_sigma_deg, 4.8) << "feet tell more than the lifter alone";
  EXPECT_LT(world.height_sigma_m, 0.05);

  TrackSequenceSummary floats = Standing(1);
  floats.ground.stances.clear();
  floats.ground.has_plane = false;
  const WorldFrame one = WorldOfScene(JoinScenes({Standing(-1), floats}, FocalPrior::ForImage(1280, 720)), OneFrame());
  EXPECT_EQ(one.source, WorldSource::kGround);
  EXPECT_EQ(one.vertical_sigma_deg, 3);
  EXPECT_EQ(one.height_sigma_m, 0.05);
  EXPECT_EQ(WorldOfScene(SharedScene(), OneFrame()).source, WorldSource::kLevelCamera);
}

TEST(TrackWorld, LevelsAreThoseOfTheShotsOwnGround) {
  GroundSummary ground;
  ground.has_up = ground.has_plane = true;
  ground.up = Eigen::Vector3d(0, -1, -0.1).normalized();
  ground.camera_height_m = 1.7;
  FrameGround floor, box, of_other_shot;
  floor.up = box.up = ground.up;
  floor.level_m = -1.7;
  box.level_m = -1.25;
  of_other_shot.level_m = -1;
  std::vector<FrameData> frames(4);
  frames[0].ground = &floor;
  frames[1].ground = &of_other_shot;
  EXPECT_EQ(LevelsOverGround(frames, ground).size(), 0) << "the ground alone";
  frames[2].ground = &box;
  EXPECT_TRUE(LevelsOverGround(frames, ground).isApprox(Eigen::Vector4d(0, 0, 0.45, 0), 1e-12));
  ground.has_plane = false;
  EXPECT_EQ(LevelsOverGround(frames, ground).size(), 0);
}

/// One frame of somebody whose pelvis is 1 m over a level of their own fit, whose ground is `ground_m` under a level
/// camera.
TrackSequenceResult Upright(double ground_m, double level_m) {
  TrackSequenceResult person;
  person.summary = Standing(0);
  person.summary.ground.camera_height_m = ground_m;
  person.track.joints = {(MatrixX3d(1, 3) << 0, ground_m - level_m - 1, 4).finished()};
  person.track.motion.poses.setZero(1, 3);
  person.track.motion.trans.setZero(1, 3);
  person.track.frame_status = {FrameStatus::kTracked};
  if (level_m != 0) person.track.level_m = Eigen::VectorXd::Constant(1, level_m);
  return person;
}

TEST(TrackWorld, LevelsAreOverTheCommonGround) {
  SharedScene scene;
  scene.has_up = scene.ground.has_plane = true;
  scene.ground.up = Eigen::Vector3d(0, -1, 0);
  scene.ground.camera_height_m = 1.5;
  scene.source = WorldSource::kPeople;
  std::vector<TrackSequenceResult> people = {Upright(1.5, 0), Upright(1.45, 0), Upright(0.9, 0), Upright(1.45, 0.4)};
  ShareWorld(scene, &people);
  EXPECT_EQ(people[0].track.level_m.size(), 0);
  EXPECT_EQ(people[1].track.level_m.size(), 0) << "5 cm are the error of a fit";
  EXPECT_NEAR(people[2].track.LevelAt(0), 0.6, 1e-12) << "on a roof";
  EXPECT_NEAR(people[3].track.LevelAt(0), 0.45, 1e-12);
  scene.ground.has_plane = false;
  ShareWorld(scene, &people);
  EXPECT_EQ(people[3].track.level_m.size(), 0) << "the world's ground is then below the lowest joint";
}

}  // namespace
}  // namespace bodyloom::track_world_test
