// SPDX-License-Identifier: Apache-2.0
#include "geometry/cloth/body_with_garment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <vector>

#include "geometry/body/posed_body.h"
#include "geometry/cloth/cloth_body.h"
#include "geometry/uv_maps/uv_texels.h"
#include "tests/support/toy_body.h"

namespace bodyloom::body_with_garment_test {
namespace {

class BodyWithGarmentTest : public ::testing::Test {
 protected:
  static LooseGarment Cut(const BodyModel& body) {
    LooseGarmentOptions options;
    options.waist_y_m = body.joint_template()(3, 1), options.length_m = 0.5, options.fullness = 0.4;
    return ClothCollisionBody(body, Eigen::VectorXd(), {}).Cut(options, 1);
  }
  const BodyModel& body_ = ToyBody();
  const LooseGarment garment_ = Cut(body_);
  const BodyModel both_{BodyWithGarment(body_, garment_)};
};

TEST_F(BodyWithGarmentTest, KeepsTheBodyAndItsJoints) {
  EXPECT_EQ(both_.num_vertices(), body_.num_vertices() + static_cast<int>(garment_.drawn_from.size()));
  EXPECT_EQ(both_.num_faces(), body_.num_faces() + static_cast<int>(garment_.drawn_faces.rows()));
  Eigen::VectorXd betas = Eigen::VectorXd::Constant(body_.num_betas(), 0.7);
  EXPECT_LT((both_.RestJoints(betas) - body_.RestJoints(betas)).cwiseAbs().maxCoeff(), 1e-12);
  Eigen::VectorXd pose = 0.3 * Eigen::VectorXd::Ones(72);
  const MatrixX3d alone = PoseVertices(body_, betas, PoseFromAxisAngle(body_, pose, {1, 2, 3})),
                  both = PoseVertices(both_, betas, PoseFromAxisAngle(both_, pose, {1, 2, 3}));
  EXPECT_LT((both.topRows(alone.rows()) - alone).cwiseAbs().maxCoeff(), 1e-12);
}

TEST_F(BodyWithGarmentTest, TakenOffAgainIsTheBodyOnASmallerPartOfTheAtlas) {
  const BodyModel off(BodyWithoutGarment(both_, body_.num_vertices()));
  EXPECT_EQ(off.data().v_template, body_.data().v_template);
  EXPECT_EQ(off.data().faces, body_.data().faces);
  EXPECT_EQ(off.data().shapedirs, body_.data().shapedirs);
  EXPECT_EQ(off.data().posedirs.begin, body_.data().posedirs.begin);
  EXPECT_EQ(off.data().posedirs.block, body_.data().posedirs.block);
  EXPECT_EQ(off.data().face_part, body_.data().face_part);
  EXPECT_LT((off.data().weights - body_.data().weights).norm(), 1e-12) << "normalised anew";
  EXPECT_LT((off.data().J_regressor - body_.data().J_regressor).norm(), 1e-12);
  EXPECT_EQ(off.data().ft, body_.data().ft);
  EXPECT_THROW(BodyWithoutGarment(both_, body_.num_vertices() - 1), std::invalid_argument);
  EXPECT_THROW(BodyWithoutGarment(both_, both_.num_vertices() + 1), std::invalid_argument);
}

TEST_F(BodyWithGarmentTest, HasAnAtlasInWhichNothingOverlaps) {
  UvTexelOptions size{.width = 256, .height = 256, .gutter = 1};
  const UvTexelTable table = BuildUvTexelTable(both_, size), alone = BuildUvTexelTable(body_, size);
  EXPECT_EQ(table.faces_outside, 0);
  EXPECT_LE(table.overlapping, alone.overlapping);
  int of_garment = 0;
  for (size_t i = 0; i < table.size(); ++i) of_garment += table.face[i] >= body_.num_faces() ? 1 : 0;
  EXPECT_GT(of_garment, 256 * 256 / 8);
}

TEST_F(BodyWithGarmentTest, GoesWithBothLegsInTheMiddleAndNeverWithArms) {
  const int V = body_.num_vertices();
  for (int v = V; v < both_.num_vertices(); ++v) {
    double left = 0, right = 0, arms = 0;
    for (int i = both_.influence_begin()[v]; i < both_.influence_begin()[v + 1]; ++i) {
      const int joint = both_.influence_joint()[i];
      if (joint == 1 || joint == 4) left += both_.influence_weight()[i];
      if (joint == 2 || joint == 5) right += both_.influence_weight()[i];
      if (joint >= 12) arms += both_.influence_weight()[i];
    }
    EXPECT_EQ(arms, 0);
    const double x = both_.data().v_template(v, 0);
    if (x > 0.1) {
      EXPECT_GE(left, right);
    }
    if (x < -0.1) {
      EXPECT_GE(right, left);
    }
  }
}

TEST_F(BodyWithGarmentTest, ClothLandsInTheLastRows) {
  MatrixX3d vertices = MatrixX3d::Zero(both_.num_vertices(), 3);
  std::vector<Eigen::Vector3d> cloth(garment_.sewn.size());
  for (size_t i = 0; i < cloth.size(); ++i) cloth[i] = Eigen::Vector3d(double(i) + 1, 0, 0);
  PlaceGarment(garment_, cloth, &vertices);
  EXPECT_EQ(vertices.topRows(body_.num_vertices()).norm(), 0);
  for (size_t d = 0; d < garment_.drawn_from.size(); ++d) {
    EXPECT_EQ(vertices(body_.num_vertices() + static_cast<int>(d), 0), garment_.drawn_from[d] + 1);
  }
  cloth.pop_back();
  EXPECT_THROW(PlaceGarment(garment_, cloth, &vertices), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::body_with_garment_test
