// SPDX-License-Identifier: Apache-2.0
#include "geometry/scene/world_frame.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>
#include <stdexcept>

namespace bodyloom::world_frame_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void ExpectIsWorld(const WorldFrame& world, const Vector3d& up, double height) {
  EXPECT_TRUE((world.rotation * world.rotation.transpose()).isIdentity(1e-12));
  EXPECT_NEAR(world.rotation.determinant(), 1, 1e-12);
  EXPECT_TRUE((world.rotation * up.normalized()).isApprox(Vector3d::UnitY(), 1e-12));
  EXPECT_TRUE(world.PointFromCamera(Vector3d::Zero()).isApprox(Vector3d(0, height, 0), 1e-12));
  const Vector3d on_ground = -height * up.normalized() + 3 * up.unitOrthogonal();
  EXPECT_NEAR(world.PointFromCamera(on_ground).y(), 0, 1e-12);
}

TEST(WorldFrame, OfALevelCamera) {
  const WorldFrame world = WorldOverGround({0, -1, 0}, 1.5);
  ExpectIsWorld(world, {0, -1, 0}, 1.5);
  EXPECT_TRUE(world.rotation.isApprox(Matrix3d(Vector3d(1, -1, -1).asDiagonal()), 1e-12));
  EXPECT_TRUE(world.PointFromCamera({1, 1.5, 4}).isApprox(Vector3d(1, 0, -4), 1e-12)) << "right, ground, ahead";
}

TEST(WorldFrame, HeadsWhereATiltedCameraLooks) {
  for (const Vector3d& up : {Vector3d(0.1, -1, -0.3), Vector3d(-0.5, -0.7, 0.4), Vector3d(0.2, 1, 0.1)}) {
    const WorldFrame world = WorldOverGround(2 * up, 0.9);
    ExpectIsWorld(world, up, 0.9);
    const Vector3d ahead = world.rotation * Vector3d::UnitZ();
    EXPECT_NEAR(ahead.x(), 0, 1e-12);
    EXPECT_LT(ahead.z(), 0);
    const CameraPose pose = world.camera_pose();
    const Vector3d p(0.3, -0.2, 5);
    EXPECT_TRUE((pose.camera_from_world_rotation * world.PointFromCamera(p) + pose.camera_from_world_translation)
                    .isApprox(p, 1e-12));
    const MatrixX3d rows = world.PointsFromCamera(p.transpose());
    EXPECT_TRUE(rows.row(0).transpose().isApprox(world.PointFromCamera(p), 1e-12));
  }
}

TEST(WorldFrame, StraightDownTheUpperEdgeIsAhead) {
  const WorldFrame world = WorldOverGround(-Vector3d::UnitZ(), 2);
  ExpectIsWorld(world, -Vector3d::UnitZ(), 2);
  EXPECT_TRUE((world.rotation * Vector3d(0, -1, 0)).isApprox(-Vector3d::UnitZ(), 1e-12));
}

TEST(WorldFrame, RefusesWhatIsNoVertical) {
  EXPECT_THROW(WorldOverGround(Vector3d::Zero(), 1), std::invalid_argument);
  EXPECT_THROW(WorldOverGround({0, std::numeric_limits<double>::quiet_NaN(), 0}, 1), std::invalid_argument);
  EXPECT_THROW(WorldOverGround({0, -1, 0}, std::numeric_limits<double>::infinity()), std::invalid_argument);
}

TEST(WorldFrame, SourcesHaveNames) {
  for (const WorldSource source : {WorldSource::kLevelCamera, WorldSource::kVertical, WorldSource::kGround,
                                   WorldSource::kPeople, WorldSource::kGiven}) {
    EXPECT_EQ(WorldSourceFromString(ToString(source)), source);
  }
  EXPECT_THROW(WorldSourceFromString("guessed"), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::world_frame_test
