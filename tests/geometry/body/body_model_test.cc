// SPDX-License-Identifier: Apache-2.0
#include "geometry/body/body_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/geometry/random_body.h"
#include "tests/support/toy_body.h"

namespace bodyloom::body_model_test {
namespace {

using ::testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

RandomBodyOptions SmallBody() {
  RandomBodyOptions options;
  options.num_vertices = 60;
  options.num_betas = 4;
  options.num_faces = 20;
  return options;
}

struct Defect {
  const char* message;
  std::function<void(BodyModelData*)> damage;
};

void PrintTo(const Defect& defect, std::ostream* out) { *out << defect.message; }

class BodyModelRefuses : public ::testing::TestWithParam<Defect> {};

TEST_P(BodyModelRefuses, WithAMessageThatNamesArrayAndValue) {
  BodyModelData data = RandomBodyData(SmallBody());
  ASSERT_NO_THROW(BodyModel{data});
  GetParam().damage(&data);
  try {
    BodyModel model(std::move(data));
    FAIL() << "accepted, expected: " << GetParam().message;
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), HasSubstr(GetParam().message));
  }
}

using D = BodyModelData;

INSTANTIATE_TEST_SUITE_P(
    Body, BodyModelRefuses,
    ::testing::Values(
        Defect{"v_template is empty", [](D* d) { d->v_template.resize(0, 3); }},
        Defect{"no joints", [](D* d) { d->parents.clear(); }},
        Defect{"v_template holds NaN", [](D* d) { d->v_template(7, 1) = kNan; }},
        Defect{"shapedirs has 177 rows, expected 3V = 180",
               [](D* d) { d->shapedirs = RowMatrixXf(d->shapedirs.topRows(177)); }},
        Defect{"shapedirs holds NaN", [](D* d) { d->shapedirs(9, 2) = std::numeric_limits<float>::infinity(); }},
        Defect{"J_regressor is 24x59, expected JxV = 24x60", [](D* d) { d->J_regressor.conservativeResize(24, 59); }},
        Defect{"J_regressor is 23x60", [](D* d) { d->J_regressor.conservativeResize(23, 60); }},
        Defect{"weights is 60x23, expected VxJ = 60x24", [](D* d) { d->weights.conservativeResize(60, 23); }},
        Defect{"weights is 59x24", [](D* d) { d->weights.conservativeResize(59, 24); }},
        Defect{"parent of joint 0 is 0, expected -1", [](D* d) { d->parents[0] = 0; }},
        Defect{"parent of joint 5 is 5, expected an earlier joint", [](D* d) { d->parents[5] = 5; }},
        Defect{"parent of joint 5 is -1", [](D* d) { d->parents[5] = -1; }},
        Defect{"3 joint names for 24 joints",
               [](D* d) {
                 d->joint_names = {"a", "b", "c"};
               }},
        Defect{"pose_mean has 9 values, expected 3J = 72", [](D* d) { d->pose_mean.setZero(9); }},
        Defect{"pose_mean holds NaN",
               [](D* d) {
                 d->pose_mean.setZero(72);
                 d->pose_mean[71] = kNan;
               }},
        Defect{"a face names vertex 60, expected 0..59", [](D* d) { d->faces(19, 2) = 60; }},
        Defect{"a face names vertex -3", [](D* d) { d->faces(0, 0) = -3; }},
        Defect{"ft has 3 faces, expected 20", [](D* d) { d->ft.setZero(3, 3); }},
        Defect{"ft names UV vertex 0, expected 0..-1", [](D* d) { d->ft.setZero(20, 3); }},
        Defect{"ft names UV vertex -1, expected 0..4",
               [](D* d) {
                 d->ft.setZero(20, 3);
                 d->ft(3, 1) = -1;
                 d->vt.setZero(5, 2);
               }},
        Defect{"vt holds NaN",
               [](D* d) {
                 d->ft.setZero(20, 3);
                 d->vt.setConstant(5, 2, kNan);
               }},
        Defect{"face_part has 19 entries, expected 20", [](D* d) { d->face_part.assign(19, 1); }},
        Defect{"face_iuv is 20x5, expected 20x6", [](D* d) { d->face_iuv.setZero(20, 5); }},
        Defect{"face_iuv holds NaN", [](D* d) { d->face_iuv.setConstant(20, 6, kNan); }},
        Defect{"landmark 'nose' has 0 vertices",
               [](D* d) {
                 d->landmarks[0] = {"nose", {}, {}};
               }},
        Defect{"landmark 'nose' has 1 vertices and 2 weights", [](D* d) { d->landmarks[0].weights.push_back(0); }},
        Defect{"landmark 'left_eye' names vertex 60", [](D* d) { d->landmarks[1].vertices[2] = 60; }},
        Defect{"the weights of landmark 'left_eye' sum to 0.5", [](D* d) { d->landmarks[1].weights[1] = 0.2; }},
        Defect{"the weights of landmark 'nose' sum to nan", [](D* d) { d->landmarks[0].weights[0] = kNan; }},
        Defect{"pose correctives without vertex offsets", [](D* d) { d->posedirs.begin.clear(); }},
        Defect{"offsets do not match 60 vertices", [](D* d) { d->posedirs.begin.pop_back(); }},
        Defect{"offsets do not match", [](D* d) { d->posedirs.begin[0] = 1; }},
        Defect{"offsets do not match", [](D* d) { d->posedirs.begin[30] = d->posedirs.begin[31] + 1; }},
        Defect{"offsets do not match", [](D* d) { d->posedirs.begin.back() += 1; }},
        Defect{"pose correctives hold 4859 values, expected 4860", [](D* d) { d->posedirs.block.pop_back(); }},
        Defect{"a pose corrective names joint 24, expected 1..23", [](D* d) { d->posedirs.joint[4] = 24; }},
        Defect{"a pose corrective names joint 0, expected 1..23", [](D* d) { d->posedirs.joint[4] = 0; }},
        Defect{"posedirs holds NaN", [](D* d) { d->posedirs.block[100] = kNan; }},
        Defect{"row 3 of J_regressor sums to 2, expected 1", [](D* d) { d->J_regressor.row(3) *= 2; }},
        Defect{"row 59 of weights sums to 0.5, expected 1", [](D* d) { d->weights.row(59) *= 0.5; }},
        Defect{"row 0 of weights sums to nan", [](D* d) { d->weights.coeffRef(0, 0) = kNan; }},
        Defect{"row 1 of weights names column 24, expected 0..23", [](D* d) {
                 d->weights.makeCompressed();
                 d->weights.innerIndexPtr()[d->weights.outerIndexPtr()[1]] = 24;
               }}));

TEST(BodyModel, RowsThatSumToAlmostOneAreNormalised) {
  BodyModelData data = RandomBodyData(SmallBody());
  data.weights *= 1.0009;
  data.J_regressor *= 0.9991;
  const BodyModel model(std::move(data));
  for (int v = 0; v < model.num_vertices(); ++v) {
    double sum = 0;
    for (int k = model.influence_begin()[v]; k < model.influence_begin()[v + 1]; ++k)
      sum += model.influence_weight()[k];
    EXPECT_NEAR(sum, 1, 1e-15);
  }
  const Eigen::VectorXd sums = model.data().J_regressor * Eigen::VectorXd::Ones(model.num_vertices());
  EXPECT_LT((sums.array() - 1).abs().maxCoeff(), 1e-15);
}

TEST(BodyModel, JointsFollowTheShape) {
  const BodyModel model = RandomBody(SmallBody());
  const Eigen::VectorXd betas = RandomBetas(4, 5);
  MatrixX3d shaped = model.data().v_template;
  for (int v = 0; v < 60; ++v) {
    for (int c = 0; c < 3; ++c) shaped(v, c) += model.data().shapedirs.row(3 * v + c).cast<double>().dot(betas);
  }
  EXPECT_LT((model.RestJoints(betas) - model.data().J_regressor * shaped).norm(), 1e-14);
  EXPECT_EQ(model.RestJoints(Eigen::VectorXd()), model.joint_template());
  Eigen::VectorXd padded = betas;
  padded.tail(2).setZero();
  EXPECT_LT((model.RestJoints(betas.head(2)) - model.RestJoints(padded)).norm(), 1e-15);
  EXPECT_THROW((void)model.RestJoints(RandomBetas(5, 5)), std::invalid_argument);
}

TEST(BodyModel, TreeInfluencesAndNames) {
  BodyModelData data = RandomBodyData(SmallBody());
  int untouched = 0;
  while (data.weights.coeff(5, untouched) != 0) ++untouched;
  data.weights.coeffRef(5, untouched) = 0;  // an explicit zero must not become an influence
  const BodyModel model(std::move(data));
  EXPECT_EQ(model.ancestors(0), std::vector<int>({0}));
  EXPECT_EQ(model.ancestors(22), std::vector<int>({0, 3, 6, 9, 13, 16, 18, 20, 22}));
  for (int v = 0; v < 60; ++v) {
    double dense = 0, listed = 0;
    for (int j = 0; j < 24; ++j) dense += (j + 1) * model.data().weights.coeff(v, j);
    for (int k = model.influence_begin()[v]; k < model.influence_begin()[v + 1]; ++k) {
      EXPECT_GT(model.influence_weight()[k], 0);
      listed += (model.influence_joint()[k] + 1) * model.influence_weight()[k];
    }
    EXPECT_NEAR(dense, listed, 1e-14);
  }
  EXPECT_EQ(model.FindJoint("l_knee"), 4);
  EXPECT_EQ(model.FindJoint("tail"), -1);
  EXPECT_EQ(model.FindLandmark("left_eye"), 1);
  EXPECT_EQ(model.FindLandmark("tail"), -1);
  EXPECT_FALSE(model.has_uv());
  EXPECT_TRUE(ToyBody().has_uv());
  EXPECT_TRUE(ToyBody().has_parts());
}

TEST(BodyModel, JointNamesBeyondSmplAreNumbered) {
  RandomBodyOptions options = SmallBody();
  options.num_joints = 26;
  EXPECT_EQ(RandomBody(options).FindJoint("joint_25"), 25);
  EXPECT_EQ(SmplJointNames().size(), SmplParents().size());
}

TEST(BodyModel, ABodyWithoutShapeOrCorrectives) {
  RandomBodyOptions options = SmallBody();
  options.correctives_per_vertex = 0;
  BodyModelData data = RandomBodyData(options);
  data.shapedirs.resize(0, 0);
  const BodyModel model(std::move(data));
  EXPECT_EQ(model.num_betas(), 0);
  EXPECT_EQ(model.RestJoints(Eigen::VectorXd()), model.joint_template());
  EXPECT_THROW((void)model.RestJoints(RandomBetas(1, 1)), std::invalid_argument);
}

TEST(BodyModel, DenseCorrectivesBecomeBlocks) {
  const int V = 5, J = 4, columns = 9 * (J - 1);
  std::vector<float> dense(3 * V * columns, 0.f);
  const auto at = [&](int v, int c, int j, int k) -> float& { return dense[(3 * v + c) * columns + 9 * (j - 1) + k]; };
  at(0, 2, 1, 0) = 1;
  at(0, 0, 3, 8) = -2;
  at(3, 1, 2, 4) = 1e-6f;
  at(4, 0, 1, 0) = kNan;
  const PoseCorrectives exact = PoseCorrectivesFromDense(dense.data(), V, J);
  EXPECT_EQ(exact.begin, std::vector<int>({0, 2, 2, 2, 3, 4}));
  EXPECT_EQ(exact.joint, std::vector<int>({1, 3, 2, 1}));
  ASSERT_EQ(exact.block.size(), 4u * 27);
  EXPECT_EQ(exact.block[9 * 2 + 0], 1);
  EXPECT_EQ(exact.block[27 + 9 * 0 + 8], -2);
  EXPECT_EQ(exact.block[54 + 9 * 1 + 4], 1e-6f);
  EXPECT_TRUE(std::isnan(exact.block[81]));  // not lost: the constructor refuses it
  EXPECT_EQ(PoseCorrectivesFromDense(dense.data(), V, J, 1e-5f).joint, std::vector<int>({1, 3, 1}));
  const std::vector<float> zero(3 * V * columns, 0.f);
  EXPECT_TRUE(PoseCorrectivesFromDense(zero.data(), V, J).empty());
  EXPECT_TRUE(PoseCorrectivesFromDense(zero.data(), V, J).begin.empty());
}

}  // namespace
}  // namespace bodyloom::body_model_test
