// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <utility>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "geometry/scene/track_edits.h"

#include "data_tools/body/builtin_body.h"
#include "data_tools/descriptors/person_frames.h"
#include "geometry/body/normals.h"
#include "geometry/body/posed_body.h"
#include "render/uv_maps/posed_track.h"
#include "tests/support/short_track.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::track_edits_test {
namespace {

const Eigen::VectorXd kShape = (Eigen::VectorXd(6) << 1.2, -0.7, 0.5, 0.3, -1.1, 0.9).finished();

TEST(BakeShape, WithoutOffsetsEveryPoseIsThePersons) {
  const BodyModel& body = ToyBody();
  const BodyModel baked(BakeShape(body, kShape, {}));
  for (uint32_t seed : {1, 2, 3}) {
    const BodyPose pose = RandomPose(body, seed, 0.8, 2.0);
    const MatrixX3d expected = PoseVertices(body, kShape, pose), found = PoseVertices(baked, Eigen::VectorXd(), pose);
    EXPECT_LT((expected - found).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(BakeShape, ATrackOfThePersonIsFollowedByTheBakedBody) {
  const BodyModel& body = ToyBody();
  const BodyModel baked(BakeShape(body, kShape, {}));
  Track track;
  track.motion.betas = kShape;
  track.motion.poses = Eigen::MatrixXd::Constant(2, 3 * body.num_joints(), 0.1);
  track.joints.resize(2);
  const Track moved = OfBakedBody(track);
  EXPECT_EQ(moved.motion.poses, track.motion.poses);
  EXPECT_TRUE(moved.joints.empty());
  const BodyPose pose = RandomPose(body, 4, 0.8, 2.0);
  const MatrixX3d expected = PoseVertices(body, track.motion.betas, pose);
  EXPECT_LT((expected - PoseVertices(baked, moved.motion.betas, pose)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(BakeShape, VerticesStandOffAlongTheirNormals) {
  const BodyModel& body = ToyBody();
  std::vector<double> offsets(body.num_vertices());
  for (int v = 0; v < body.num_vertices(); ++v) offsets[v] = 0.001 * (v % 40) - 0.01;
  const BodyModelData baked = BakeShape(body, kShape, offsets);
  const MatrixX3d bare = ShapeVertices(body, kShape);
  const MatrixX3f normals = VertexNormals(bare, body.data().faces);
  for (int v = 0; v < body.num_vertices(); ++v) {
    const Eigen::RowVector3d expected = bare.row(v) + offsets[v] * normals.row(v).cast<double>();
    EXPECT_LT((baked.v_template.row(v) - expected).norm(), 1e-12);
  }
}

TEST(BakeShape, JointsAndLandmarksStayWhereTheBareBodyHasThem) {
  const BodyModel& body = ToyBody();
  std::vector<double> offsets(body.num_vertices());
  for (int v = 0; v < body.num_vertices(); ++v) offsets[v] = 0.002 * (v % 11);  // uneven: means would move
  const BodyModel baked(BakeShape(body, kShape, offsets));
  const MatrixX3d joints = body.RestJoints(kShape);
  EXPECT_GT((baked.data().v_template - ShapeVertices(body, kShape)).rowwise().norm().maxCoeff(), 0.015);
  EXPECT_LT((baked.joint_template() - joints).rowwise().norm().maxCoeff(), 1e-9);
  const MatrixX3d bare = ShapeVertices(body, kShape);
  int held = 0;
  for (size_t i = 0; i < body.data().landmarks.size(); ++i) {
    const Landmark &before = body.data().landmarks[i], &after = baked.data().landmarks[i];
    if (before.vertices.size() < 4) continue;
    Eigen::RowVector3d expected = Eigen::RowVector3d::Zero(), found = expected;
    for (size_t k = 0; k < before.vertices.size(); ++k) {
      expected += before.weights[k] * bare.row(before.vertices[k]);
      found += after.weights[k] * baked.data().v_template.row(after.vertices[k]);
    }
    EXPECT_LT((expected - found).norm(), 1e-9) << before.name;
    ++held;
  }
  EXPECT_GT(held, 4);
}

TEST(BakeShape, ALandmarkOnAFlatPatchIsNotHeldByHugeWeights) {
  BodyModelData data = ToyBody().data();
  // The corners of two neighbouring faces: nearly in one plane, which clothes carry away as a whole.
  std::vector<int> patch = {data.faces(0, 0), data.faces(0, 1), data.faces(0, 2)};
  for (int f = 1; patch.size() < 4; ++f) {
    std::vector<int> own, other;
    for (int c = 0; c < 3; ++c) {
      (std::find(patch.begin(), patch.end(), data.faces(f, c)) != patch.end() ? own : other)
          .push_back(data.faces(f, c));
    }
    if (own.size() == 2) patch.push_back(other[0]);
  }
  data.landmarks.push_back({"patch", patch, {0.25, 0.25, 0.25, 0.25}});
  const BodyModel body(data);
  const BodyModelData baked = BakeShape(body, Eigen::VectorXd(), std::vector<double>(body.num_vertices(), 0.15));
  double sum = 0;
  for (const double weight : baked.landmarks.back().weights) {
    EXPECT_LE(std::abs(weight), 1.5);
    sum += weight;
  }
  EXPECT_NEAR(sum, 1, 1e-9);
}

TEST(BakeShape, RefusesWhatDoesNotFit) {
  const BodyModel& body = ToyBody();
  std::vector<double> offsets(body.num_vertices() - 1, 0.0);
  EXPECT_THROW(BakeShape(body, kShape, offsets), std::invalid_argument);
  offsets.push_back(std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(BakeShape(body, kShape, offsets), std::invalid_argument);
  EXPECT_THROW(BakeShape(body, Eigen::VectorXd::Zero(7), {}), std::invalid_argument);
}

using ::testing::ElementsAre;

TEST(FreezeTrack, ShowsOneFrameLonger) {
  EXPECT_THAT(FrozenAt(4, 1, 3), ElementsAre(0, 1, 1, 1, 1, 2, 3));
  EXPECT_THAT(FrozenAt(2, 1, 0), ElementsAre(0, 1));
  EXPECT_THROW(FrozenAt(4, 4, 1), std::invalid_argument);
  EXPECT_THROW(FrozenAt(4, -1, 1), std::invalid_argument);
  EXPECT_THROW(FrozenAt(4, 0, -1), std::invalid_argument);
}

TEST(PosedSpan, GoesFromTheFirstPoseToTheLast) {
  Motion motion = ShortTrack().motion;
  const int T = motion.num_frames();
  EXPECT_EQ(PosedSpan(motion), std::pair(0, T));
  motion.poses.row(0).setConstant(NAN);
  motion.trans.row(2).setConstant(NAN);  // a hole
  motion.poses.row(T - 1).setConstant(NAN);
  EXPECT_EQ(PosedSpan(motion), std::pair(1, T - 1));
  const Motion part = FramesOfMotion(motion, 1, T - 1);
  ASSERT_EQ(part.num_frames(), T - 2);
  EXPECT_EQ(part.poses.row(0), motion.poses.row(1));
  EXPECT_EQ(part.trans.row(T - 3), motion.trans.row(T - 2));
  EXPECT_EQ(part.timestamps.front(), motion.timestamps[1]);
  EXPECT_EQ(part.betas, motion.betas);
  motion.poses.setConstant(NAN);
  EXPECT_EQ(PosedSpan(motion), std::pair(0, 0));
  EXPECT_THROW(FramesOfMotion(motion, 2, 1), std::invalid_argument);
  EXPECT_THROW(FramesOfMotion(motion, 0, T + 1), std::invalid_argument);
}

TEST(FreezeTrack, TheClockGoesOn) {
  const Track track = ShortTrack();
  const Track shown = FramesInOrder(track, FrozenAt(track.num_frames(), 2, 3));
  ASSERT_EQ(shown.num_frames(), track.num_frames() + 3);
  const double frame_s = track.motion.timestamps[1] - track.motion.timestamps[0];
  for (int t = 0; t < shown.num_frames(); ++t) {
    const int from = t <= 2 ? t : std::max(2, t - 3);
    EXPECT_EQ(shown.motion.poses.row(t), track.motion.poses.row(from)) << t;
    EXPECT_EQ(shown.joints[t], track.joints[from]) << t;
    EXPECT_NEAR(shown.motion.timestamps[t], track.motion.timestamps[0] + t * frame_s, 1e-9) << t;
  }
  const std::vector<int> none = {0, track.num_frames()};
  EXPECT_THROW(FramesInOrder(track, none), std::invalid_argument);
}

TEST(FreezeTrack, AFrozenFrameMovesAsItDid) {
  const Track track = ShortTrack();
  PersonFramesOptions options;
  options.uv_size = 16;
  options.past = 3;
  options.window.max_side = 96;
  const PersonFrames plain(BuiltinBody(), track, options);
  options.shown = FrozenAt(track.num_frames(), 5, 2);
  const PersonFrames frozen(BuiltinBody(), track, options);
  ASSERT_EQ(frozen.num_frames(), track.num_frames() + 2);
  std::vector<float> expected(size_t(plain.channels()) * 16 * 16), maps = expected;
  double speed = 0;
  for (int t = 0; t < frozen.num_frames(); ++t) {
    plain.MotionMaps(options.shown[t], expected);
    frozen.MotionMaps(t, maps);
    EXPECT_EQ(maps, expected) << t;
    EXPECT_EQ(frozen.Segment(t), 0);
    if (t != 7) continue;
    for (size_t i = 3 * 16 * 16; i < maps.size(); ++i) speed += std::abs(maps[i]);
  }
  EXPECT_GT(speed, 1);  // nothing has come to rest

  // Seen from another side, it moves with the view.
  options.yaw_deg.assign(frozen.num_frames(), 0);
  options.yaw_deg[7] = 90;
  const PersonFrames turned(BuiltinBody(), track, options);
  plain.MotionMaps(5, expected);
  turned.MotionMaps(7, maps);
  for (size_t i = 0; i < 256; ++i) {
    for (const size_t map : {size_t{0}, size_t{3}, size_t{9}}) {
      // Turned by 90° about y: x comes from z, z from −x.
      EXPECT_NEAR(maps[(map + 0) * 256 + i], expected[(map + 2) * 256 + i], 1e-3);
      EXPECT_NEAR(maps[(map + 1) * 256 + i], expected[(map + 1) * 256 + i], 1e-3);
      EXPECT_NEAR(maps[(map + 2) * 256 + i], -expected[(map + 0) * 256 + i], 1e-3);
    }
  }
}

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
  track.level_m = Eigen::VectorXd::Constant(track.num_frames(), 0.5);
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
  EXPECT_NEAR(in_image.LevelAt(0), 0.5 * s, 1e-12);
  EXPECT_EQ(in_scene.LevelAt(0), 0.5);
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

}  // namespace bodyloom::track_edits_test
