// SPDX-License-Identifier: Apache-2.0
#include "render/view/floor.h"

#include <gtest/gtest.h>

#include "render/view/follow_view.h"

namespace bodyloom::track_world_test {
namespace {

using Eigen::Vector3d;

std::vector<MatrixX3d> TwoFrames() {
  MatrixX3d first(2, 3), lost(0, 3);
  first << 0, 1.2, 4, 0.1, -0.5, 4;  // a foot 1.2 m under a level camera
  return {first, lost};
}

TEST(TrackWorld, WithoutAnyWordTheCameraIsLevelAndTheGroundUnderTheLowestJoint) {
  const Track silent;
  const WorldFrame world = WorldOfTracks({&silent}, TwoFrames());
  EXPECT_EQ(world.source, WorldSource::kLevelCamera);
  EXPECT_NEAR(world.PointFromCamera({0, 1.2, 4}).y(), 0.04, 1e-9);
  EXPECT_TRUE(world.up_in_camera().isApprox(Vector3d(0, -1, 0), 1e-12));
  EXPECT_EQ(AssumedWorld({}).camera_height_m(), 0) << "nobody is known";
}

TEST(TrackWorld, TheVerticalAloneHasTheGroundUnderTheLowestJoint) {
  const Vector3d up = Vector3d(0, -1, -0.3).normalized();
  const WorldFrame world = WorldUnderJoints(up, TwoFrames());
  EXPECT_EQ(world.source, WorldSource::kVertical);
  EXPECT_NEAR(world.PointFromCamera({0, 1.2, 4}).y(), 0.04, 1e-9);
}

TEST(TrackWorld, TheSurestOfAllCounts) {
  Track silent, assumed, vertical, ground, surer, people;
  const auto set = [](Track* track, WorldSource source, double sigma, double height) {
    track->world = WorldOverGround({0, -1, -0.2}, height);
    track->world->source = source;
    track->world->vertical_sigma_deg = sigma;
  };
  set(&assumed, WorldSource::kLevelCamera, 0, 9);
  set(&vertical, WorldSource::kVertical, 1, 1);
  set(&ground, WorldSource::kGround, 3, 2);
  set(&surer, WorldSource::kGround, 2, 3);
  set(&people, WorldSource::kPeople, 4, 4);
  const auto height = [&](const std::vector<const Track*>& tracks) {
    return WorldOfTracks(tracks, TwoFrames()).camera_height_m();
  };
  EXPECT_EQ(height({&silent, &vertical, &assumed}), 1);
  EXPECT_EQ(height({&ground, &vertical}), 2);
  EXPECT_EQ(height({&ground, &surer}), 3);
  EXPECT_EQ(height({&surer, &people, &ground}), 4);
  EXPECT_NEAR(height({&assumed}), 1.24, 1e-9);
  ground.motion.poses = RowMatrixXd::Zero(1, 72);
  EXPECT_TRUE(EstimatedUp(ground).isApprox(ground.world->up_in_camera())) << "views have the world's vertical";
}

}  // namespace
}  // namespace bodyloom::track_world_test
