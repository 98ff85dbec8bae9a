// SPDX-License-Identifier: Apache-2.0
#include "geometry/scene/track_edits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "geometry/body/normals.h"
#include "geometry/body/posed_body.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::bake_shape_test {
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

}  // namespace
}  // namespace bodyloom::bake_shape_test
