// SPDX-License-Identifier: Apache-2.0
#include "geometry/scene/track_edits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "data_tools/body/builtin_body.h"
#include "render/uv_maps/posed_track.h"
#include "tests/support/short_track.h"

namespace bodyloom::shape_track_test {
namespace {

using Eigen::VectorXd;

/// A tall person: the first component is stature.
VectorXd Tall() {
  VectorXd betas = VectorXd::Zero(BuiltinBody().num_betas());
  betas[0] = 2;
  return betas;
}

/// Height of the pelvis above the lowest vertex, a person standing upright at rest.
double Height(const VectorXd& betas) {
  Track rest;
  rest.motion.poses = RowMatrixXd::Zero(1, 72);
  rest.motion.trans = MatrixX3d::Zero(1, 3);
  rest.motion.betas = betas;
  const PosedTrack posed(BuiltinBody(), rest);
  return posed.Root(0).y() - posed.Vertices(0).col(1).minCoeff();
}

TEST(ShapeTrack, RotationsAreTheDriversAndTheShapeIsThePersons) {
  const Track track = ShortTrack();
  const Track tall = WithShape(BuiltinBody(), track, Tall());
  EXPECT_EQ(tall.motion.poses, track.motion.poses);
  EXPECT_EQ(tall.motion.timestamps, track.motion.timestamps);
  EXPECT_EQ(tall.frame_status, track.frame_status);
  EXPECT_EQ(tall.motion.betas, Tall());
  EXPECT_TRUE(tall.joints.empty());
}

TEST(ShapeTrack, TheFloorStaysAndStepsGrowWithTheLegs) {
  const Track track = ShortTrack();
  const Track tall = WithShape(BuiltinBody(), track, Tall());
  const double r = Height(Tall()) / Height(track.motion.betas);
  ASSERT_GT(std::abs(r - 1), 0.02);
  const PosedTrack before(BuiltinBody(), track), after(BuiltinBody(), tall);
  for (int t = 1; t < track.num_frames(); ++t) {
    EXPECT_LT(((after.Root(t) - after.Root(0)) - r * (before.Root(t) - before.Root(0))).norm(), 1e-9) << t;
  }
  // The lowest point of the walk (y points down) is on the same floor, to what legs differ in proportion.
  const auto floor = [&](const PosedTrack& posed) {
    double lowest = -1e9;
    for (int t = 0; t < track.num_frames(); ++t) lowest = std::max(lowest, posed.Vertices(t).col(1).maxCoeff());
    return lowest;
  };
  EXPECT_NEAR(floor(after), floor(before), 0.01);
}

/// Lowest and highest row that the body is seen in.
std::pair<double, double> RowsOf(const Track& track, int t) {
  const MatrixX3d vertices = PosedTrack(BuiltinBody(), track).Vertices(t);
  std::pair<double, double> rows = {1e9, -1e9};
  const Camera camera = track.CameraAt(t);
  for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
    Eigen::Vector2d pixel;
    EXPECT_TRUE(camera.Project(vertices.row(v).transpose(), &pixel));
    rows = {std::min(rows.first, pixel.y()), std::max(rows.second, pixel.y())};
  }
  return rows;
}

TEST(ShapeTrack, PlacedInTheImageThePersonIsAsTallInIt) {
  Track track = ShortTrack();
  track.motion.poses.rightCols(track.motion.poses.cols() - 3).setZero();  // upright, so that stature is all of it
  track.world = WorldOverGround({0, -1, 0}, 1.4);
  const Track in_scene = WithShape(BuiltinBody(), track, Tall());
  const Track in_image = WithShape(BuiltinBody(), track, Tall(), PersonPlacing::kInImage);
  const auto [top, bottom] = RowsOf(track, 0);
  const auto [own_top, own_bottom] = RowsOf(in_scene, 0);
  const auto [same_top, same_bottom] = RowsOf(in_image, 0);
  ASSERT_GT(std::abs((own_bottom - own_top) / (bottom - top) - 1), 0.02);
  EXPECT_NEAR((same_bottom - same_top) / (bottom - top), 1, 0.01);
  EXPECT_NEAR(same_bottom, bottom, 0.01 * (bottom - top));
  // The whole scene is larger or smaller by one factor.
  const double s = in_image.world->camera_height_m() / 1.4;
  EXPECT_GT(std::abs(s - 1), 0.02);
  const Eigen::RowVector3d moved = in_image.motion.trans.row(0) - in_scene.motion.trans.row(0);
  for (int t = 1; t < track.num_frames(); ++t) {
    EXPECT_LT((in_image.motion.trans.row(t) - in_scene.motion.trans.row(t) - moved).norm(), 1e-12) << "by one step";
  }
}

TEST(ShapeTrack, PlacedInTheImageCamerasAreScaledToo) {
  Track track = ShortTrack();
  track.camera_from_scene.assign(track.num_frames(), {});
  track.camera_from_scene[2].camera_from_world_translation = {0.1, 0.2, 0.3};
  const Track moving = WithShape(BuiltinBody(), track, Tall(), PersonPlacing::kInImage);
  const Eigen::Vector3d translation = moving.camera_from_scene[2].camera_from_world_translation;
  EXPECT_LT(translation.cross(Eigen::Vector3d(0.1, 0.2, 0.3)).norm(), 1e-12);
  const double s = translation.x() / 0.1;
  EXPECT_GT(std::abs(s - 1), 0.02);
  track.camera_from_scene.clear();
  track.camera.model = CameraModel::kWeakPerspective;
  track.weak_camera = MatrixX3d::Constant(track.num_frames(), 3, 90);
  track.weak_camera.rightCols<2>().setConstant(0.3);
  const Track weak = WithShape(BuiltinBody(), track, Tall(), PersonPlacing::kInImage);
  EXPECT_NEAR(weak.weak_camera(0, 0), 90 / s, 1e-9);
  EXPECT_NEAR(weak.weak_camera(0, 1), 0.3 * s, 1e-12);
}

TEST(ShapeTrack, TheSameShapeIsTheSameTrack) {
  Track track = ShortTrack();
  track.motion.betas = Tall();
  VectorXd fewer = Tall().head(1);
  const Track same = WithShape(BuiltinBody(), track, fewer);
  EXPECT_EQ(same.motion.trans, track.motion.trans);
  EXPECT_EQ(same.joints.size(), track.joints.size());
}

TEST(ShapeTrack, WeakPerspectivePlacesFollowAndTheScaleStays) {
  Track track = ShortTrack();
  const int T = track.num_frames();
  track.camera.model = CameraModel::kWeakPerspective;
  track.motion.trans.setZero();
  track.weak_camera = MatrixX3d::Constant(T, 3, 90);
  for (int t = 0; t < T; ++t) track.weak_camera.row(t).tail<2>() << 0.1 * (t - (T - 1) / 2.0), 0.3;
  const Track tall = WithShape(BuiltinBody(), track, Tall());
  const double r = Height(Tall()) / Height(track.motion.betas);
  for (int t = 0; t < T; ++t) {
    EXPECT_EQ(tall.weak_camera(t, 0), 90);
    EXPECT_NEAR(tall.weak_camera(t, 1), r * track.weak_camera(t, 1), 1e-12);
    EXPECT_NEAR(tall.weak_camera(t, 2), 0.3, 1e-12);
  }
}

TEST(ShapeTrack, LostFramesStayLost) {
  Track track = ShortTrack();
  track.motion.trans.row(3).setConstant(std::numeric_limits<double>::quiet_NaN());
  track.frame_status[3] = FrameStatus::kLost;
  const Track tall = WithShape(BuiltinBody(), track, Tall());
  EXPECT_FALSE(tall.HasResult(3));
  EXPECT_TRUE(tall.HasResult(4));
}

TEST(ShapeTrack, RefusesShapesOfOtherBodies) {
  const Track track = ShortTrack();
  EXPECT_THROW(WithShape(BuiltinBody(), track, VectorXd::Zero(BuiltinBody().num_betas() + 1)), std::invalid_argument);
  EXPECT_THROW(WithShape(BuiltinBody(), track, VectorXd::Constant(1, std::numeric_limits<double>::quiet_NaN())),
               std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::shape_track_test
