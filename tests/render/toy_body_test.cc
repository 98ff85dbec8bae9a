// SPDX-License-Identifier: Apache-2.0
// Properties of the toy body that other tests rely on.
#include "tests/support/toy_body.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "geometry/body/posed_body.h"
#include "geometry/scene/observations.h"

namespace bodyloom::toy_body_test {
namespace {

TEST(ToyBody, IsAClosedSurfaceTurnedOutwards) {
  const BodyModelData& d = ToyBody().data();
  std::set<std::pair<int, int>> half_edges;
  double volume = 0;
  for (int f = 0; f < d.faces.rows(); ++f) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_TRUE(half_edges.emplace(d.faces(f, c), d.faces(f, (c + 1) % 3)).second) << "face " << f;
    }
    const Eigen::Vector3d a = d.v_template.row(d.faces(f, 0)), b = d.v_template.row(d.faces(f, 1)),
                          c = d.v_template.row(d.faces(f, 2));
    EXPECT_GT((b - a).cross(c - a).norm(), 1e-6) << "face " << f;
    volume += a.dot(b.cross(c)) / 6;
  }
  for (const auto& [a, b] : half_edges) EXPECT_TRUE(half_edges.contains({b, a})) << a << " " << b;
  EXPECT_GT(volume, 0.045);
  EXPECT_LT(volume, 0.09);
}

TEST(ToyBody, IsMirrorSymmetric) {
  const BodyModelData& d = ToyBody().data();
  for (int v = 0; v < d.v_template.rows(); ++v) {
    const Eigen::Vector3d mirrored = d.v_template.row(v).transpose().cwiseProduct(Eigen::Vector3d(-1, 1, 1));
    EXPECT_LT((d.v_template.rowwise() - mirrored.transpose()).rowwise().norm().minCoeff(), 1e-12) << "vertex " << v;
  }
}

TEST(ToyBody, HasWhatTestsAskFor) {
  const BodyModel& body = ToyBody();
  EXPECT_EQ(body.num_joints(), 24);
  EXPECT_EQ(body.num_vertices(), 804);
  EXPECT_EQ(body.num_betas(), 6);
  EXPECT_TRUE(body.has_uv());
  EXPECT_TRUE(body.has_parts());
  EXPECT_FALSE(body.data().posedirs.empty());
  EXPECT_LT(body.data().posedirs.joint.size(), size_t(2 * body.num_vertices())) << "correctives are meant to be sparse";
  for (const std::string& name : CocoNames()) EXPECT_GE(body.FindLandmark(name), 0) << name;
  for (const char* name : {"left_big_toe", "right_small_toe", "left_heel"})
    EXPECT_GE(body.FindLandmark(name), 0) << name;
  for (int v = 0; v < body.num_vertices(); ++v) {
    EXPECT_LE(body.influence_begin()[v + 1] - body.influence_begin()[v], 4) << "vertex " << v;
  }
  EXPECT_GT(body.joint_template().row(0).norm(), 0.1) << "the pelvis must not be the origin";
}

TEST(ToyBody, LandmarksAreWhereTheyShouldBe) {
  const BodyModel& body = ToyBody();
  const BodyPose rest = PoseFromAxisAngle(body, Eigen::VectorXd::Zero(72), Eigen::Vector3d::Zero());
  const MatrixX3d p = PoseLandmarks(body, Eigen::VectorXd(), rest,
                                    {"nose", "left_eye", "left_ear", "left_wrist", "right_wrist", "left_big_toe",
                                     "left_small_toe", "left_heel", "left_ankle", "left_shoulder"});
  EXPECT_GT(p(0, 2), p(1, 2));  // the nose is in front of the eye, the eye in front of the ear
  EXPECT_GT(p(1, 2), p(2, 2));
  EXPECT_GT(p(3, 0), 0.6);  // x is the body's left
  EXPECT_NEAR(p(4, 0), -p(3, 0), 1e-12);
  EXPECT_LT(p(5, 0), p(6, 0));  // the left big toe is inside
  EXPECT_GT(p(5, 2), p(7, 2));
  EXPECT_GT(p(8, 1), p(7, 1));
  EXPECT_GT(p(9, 1), p(8, 1) + 1.0);
}

TEST(ToyBody, ChartsAreInjective) {
  const BodyModelData& d = ToyBody().data();
  // Sampled on a grid that avoids edges, no two triangles of a chart hold the same point.
  std::set<int> parts;
  for (int part = 1; part <= 24; ++part) {
    std::vector<int> faces;
    for (int f = 0; f < d.faces.rows(); ++f) {
      if (d.face_part[f] == part) faces.push_back(f);
    }
    ASSERT_FALSE(faces.empty()) << "part " << part;
    int covered = 0;
    for (int i = 0; i < 61; ++i) {
      for (int j = 0; j < 61; ++j) {
        const Eigen::Vector2d x((i + 0.437) / 61, (j + 0.391) / 61);
        int hits = 0;
        for (int f : faces) {
          const auto uv = [&](int c) { return d.face_iuv.block<1, 2>(f, 2 * c).transpose().cast<double>().eval(); };
          const auto cross = [&](int c) {
            const Eigen::Vector2d e = uv((c + 1) % 3) - uv(c), r = x - uv(c);
            return e.x() * r.y() - e.y() * r.x();
          };
          const double a = cross(0), b = cross(1), c = cross(2);
          hits += (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
        }
        EXPECT_LE(hits, 1) << "part " << part << " at " << x.transpose();
        covered += hits;
      }
    }
    EXPECT_GT(covered, 61 * 61 / 2) << "part " << part;
  }
}

TEST(ToyBody, CorrectivesAndShapeMoveTheSurface) {
  const BodyModel& body = ToyBody();
  BodyModelData plain_data = ToyBodyData();
  plain_data.posedirs = {};
  const BodyModel plain(std::move(plain_data));
  Eigen::VectorXd axis_angle = Eigen::VectorXd::Zero(72);
  axis_angle[3 * 18 + 1] = -1.5;  // left elbow
  const BodyPose pose = PoseFromAxisAngle(body, axis_angle, Eigen::Vector3d::Zero());
  const MatrixX3d a = PoseVertices(body, Eigen::VectorXd(), pose), b = PoseVertices(plain, Eigen::VectorXd(), pose);
  const Eigen::VectorXd distance = (a - b).rowwise().norm();
  EXPECT_GT(distance.maxCoeff(), 1e-3);
  EXPECT_LT(distance.maxCoeff(), 0.03);
  EXPECT_LT((distance.array() > 0).count(), 60) << "only the elbow may move";
  for (int k = 0; k < body.num_betas(); ++k) {
    const double size =
        (ShapeVertices(body, Eigen::VectorXd::Unit(6, k)) - body.data().v_template).rowwise().norm().maxCoeff();
    EXPECT_GT(size, 0.004) << "component " << k;
    EXPECT_LT(size, 0.06) << "component " << k;
  }
}

}  // namespace
}  // namespace bodyloom::toy_body_test
