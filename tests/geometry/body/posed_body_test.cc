// SPDX-License-Identifier: Apache-2.0
#include "geometry/body/posed_body.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "geometry/math/rotation.h"
#include "tests/geometry/random_body.h"
#include "tests/geometry/slow_body.h"
#include "tests/support/toy_body.h"

namespace bodyloom::posed_body_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using ::testing::HasSubstr;

std::vector<int> AllVertices(const BodyModel& model) {
  std::vector<int> all(model.num_vertices());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

SlowBody<double> Slowly(const BodyModel& model, const VectorXd& betas, const BodyPose& pose,
                        const std::vector<int>& vertices) {
  std::vector<Slow33<double>> rotations;
  for (const Matrix3d& R : pose.rotations) {
    rotations.push_back({{{R(0, 0), R(0, 1), R(0, 2)}, {R(1, 0), R(1, 1), R(1, 2)}, {R(2, 0), R(2, 1), R(2, 2)}}});
  }
  return PoseSlowly<double>(model.data(), {betas.data(), betas.data() + betas.size()}, rotations,
                            {pose.trans.x(), pose.trans.y(), pose.trans.z()}, vertices);
}

double LargestDifference(const MatrixX3d& fast, const std::vector<Slow3<double>>& slow) {
  if (fast.rows() != static_cast<Eigen::Index>(slow.size())) return std::numeric_limits<double>::infinity();
  double largest = 0;
  for (size_t i = 0; i < slow.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double difference = std::abs(fast(i, c) - slow[i][c]);
      if (!(difference <= largest)) largest = difference;
    }
  }
  return largest;
}

struct Size {
  const char* name;
  int num_vertices, num_joints, num_betas;
};

void PrintTo(const Size& size, std::ostream* out) { *out << size.name; }

class PosedBodySizes : public ::testing::TestWithParam<Size> {};

TEST_P(PosedBodySizes, AgreeWithTheSlowTwin) {
  RandomBodyOptions options;
  options.num_vertices = GetParam().num_vertices;
  options.num_joints = GetParam().num_joints;
  options.num_betas = GetParam().num_betas;
  options.correctives_per_vertex = 1000;
  const BodyModel model = RandomBody(options);
  ASSERT_EQ(model.data().posedirs.block.size(), 27u * model.num_vertices() * (model.num_joints() - 1));
  const VectorXd betas = RandomBetas(model.num_betas(), 3);
  const BodyPose pose = RandomPose(model, 4, 3.1);
  const SlowBody<double> slow = Slowly(model, betas, pose, AllVertices(model));
  EXPECT_LT(LargestDifference(PoseVertices(model, betas, pose), slow.vertices), 1e-12);
  EXPECT_LT(LargestDifference(PoseSkeleton(model, model.RestJoints(betas), pose).joints, slow.joints), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Family, PosedBodySizes,
                         ::testing::Values(Size{"smpl", 6890, 24, 10}, Size{"smplh", 6890, 52, 16},
                                           Size{"smplx", 10475, 55, 20}),
                         [](const auto& info) { return info.param.name; });

TEST(PosedBody, ToyBodyAgreesWithTheSlowTwinInManyPoses) {
  const BodyModel& model = ToyBody();
  for (unsigned seed = 0; seed < 20; ++seed) {
    const VectorXd betas = RandomBetas(model.num_betas(), seed);
    const BodyPose pose = RandomPose(model, 100 + seed, 3.14);
    const SlowBody<double> slow = Slowly(model, betas, pose, AllVertices(model));
    EXPECT_LT(LargestDifference(PoseVertices(model, betas, pose), slow.vertices), 1e-13) << seed;
  }
}

TEST(PosedBody, AtRestItIsTheShapedTemplate) {
  const BodyModel& model = ToyBody();
  const VectorXd betas = RandomBetas(model.num_betas(), 1);
  EXPECT_LT((PoseVertices(model, betas, RestPose(model)) - ShapeVertices(model, betas)).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_EQ(ShapeVertices(model, VectorXd()), model.data().v_template);
  EXPECT_GT((ShapeVertices(model, betas) - model.data().v_template).norm(), 0.1);
}

TEST(PosedBody, TheRootTurnsAboutThePelvis) {
  const BodyModel& model = ToyBody();
  const VectorXd betas = RandomBetas(model.num_betas(), 2);
  BodyPose pose = RestPose(model);
  pose.rotations[0] = RotationFromAxisAngle({0.3, 2, -1});
  const Vector3d pelvis = model.RestJoints(betas).row(0).transpose();
  ASSERT_GT(pelvis.norm(), 0.1);
  const MatrixX3d rest = ShapeVertices(model, betas), posed = PoseVertices(model, betas, pose);
  for (int v = 0; v < model.num_vertices(); ++v) {
    const Vector3d expected = pose.rotations[0] * (rest.row(v).transpose() - pelvis) + pelvis;
    EXPECT_LT((posed.row(v).transpose() - expected).norm(), 1e-14);
  }
}

TEST(PosedBody, ChangeOfWorldFrame) {
  // R_root' = R·R_root, trans' = R(J0 + trans) + t − J0 moves every point x to R x + t.
  const BodyModel& model = ToyBody();
  const VectorXd betas = RandomBetas(model.num_betas(), 3);
  const BodyPose pose = RandomPose(model, 5);
  const Matrix3d R = RotationFromAxisAngle({1, -2, 0.5});
  const Vector3d t(3, -1, 7), root = model.RestJoints(betas).row(0).transpose();
  BodyPose moved = pose;
  moved.rotations[0] = R * pose.rotations[0];
  moved.trans = R * (root + pose.trans) + t - root;
  const MatrixX3d before = PoseVertices(model, betas, pose), after = PoseVertices(model, betas, moved);
  EXPECT_LT((after - ((before * R.transpose()).rowwise() + t.transpose())).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(PosedBody, TranslationMovesEverything) {
  const BodyModel& model = ToyBody();
  BodyPose pose = RandomPose(model, 6);
  pose.trans.setZero();
  const MatrixX3d before = PoseVertices(model, VectorXd(), pose);
  pose.trans = Vector3d(1, 2, -3);
  const MatrixX3d after = PoseVertices(model, VectorXd(), pose);
  EXPECT_LT((after - (before.rowwise() + Eigen::RowVector3d(1, 2, -3))).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(PosedBody, ASubsetEqualsTheWholeToTheBit) {
  const BodyModel& model = ToyBody();
  const VectorXd betas = RandomBetas(model.num_betas(), 4);
  const BodyPose pose = RandomPose(model, 7);
  const MatrixX3d all = PoseVertices(model, betas, pose);
  const std::vector<int> chosen = {803, 0, 17, 17, 400};
  const MatrixX3d some = PoseVertices(model, betas, pose, chosen);
  ASSERT_EQ(some.rows(), 5);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(some.row(i), all.row(chosen[i]));
  EXPECT_EQ(PoseVertices(model, betas, pose, std::vector<int>{}).rows(), 0);
  EXPECT_THROW(PoseVertices(model, betas, pose, std::vector<int>{804}), std::invalid_argument);
  EXPECT_THROW(PoseVertices(model, betas, pose, std::vector<int>{-1}), std::invalid_argument);
}

TEST(PosedBody, LandmarksAreWeightedVertices) {
  const BodyModel model = RandomBody();
  const VectorXd betas = RandomBetas(10, 5);
  const BodyPose pose = RandomPose(model, 8);
  const MatrixX3d all = PoseVertices(model, betas, pose);
  const MatrixX3d points = PoseLandmarks(model, betas, pose, {"left_eye", "nose", "left_eye"});
  ASSERT_EQ(points.rows(), 3);
  EXPECT_LT((points.row(0) - (0.3 * all.row(1) + 0.7 * all.row(2))).norm(), 1e-14);
  EXPECT_EQ(points.row(1), all.row(0));
  EXPECT_EQ(points.row(2), points.row(0));
  try {
    PoseLandmarks(model, betas, pose, {"nose", "tail"});
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), HasSubstr("no landmark 'tail'"));
  }
}

TEST(PosedBody, FewerBetasMeanZeros) {
  const BodyModel& model = ToyBody();
  VectorXd betas = RandomBetas(6, 6);
  betas.tail(4).setZero();
  const BodyPose pose = RandomPose(model, 9);
  EXPECT_LT((PoseVertices(model, betas, pose) - PoseVertices(model, betas.head(2), pose)).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_THROW(PoseVertices(model, RandomBetas(7, 1), pose), std::invalid_argument);
  EXPECT_THROW(ShapeVertices(model, RandomBetas(7, 1)), std::invalid_argument);
}

TEST(PosedBody, AxisAngleRoundTrip) {
  const BodyModel& model = ToyBody();
  VectorXd values = VectorXd::Random(72) * 1.5;
  const Vector3d trans(1, 2, 3);
  const BodyPose pose = PoseFromAxisAngle(model, values, trans);
  EXPECT_EQ(pose.trans, trans);
  EXPECT_LT((pose.rotations[5] - RotationFromAxisAngle(values.segment<3>(15))).norm(), 1e-15);
  EXPECT_LT((AxisAngleFromPose(model, pose) - values).norm(), 1e-13);
  const BodyPose head = PoseFromAxisAngle(model, values.head(66), trans);
  EXPECT_EQ(head.rotations[21], pose.rotations[21]);
  EXPECT_EQ(head.rotations[22], Matrix3d(Matrix3d::Identity()));
}

TEST(PosedBody, PoseMeanIsAddedAndTakenAway) {
  BodyModelData data = ToyBodyData();
  data.pose_mean = VectorXd::Zero(72);
  data.pose_mean.tail(6) << 0.1, 0.2, 0.3, -0.1, 0.4, 0.2;
  const BodyModel model(std::move(data));
  const VectorXd values = VectorXd::Random(72) * 0.5;
  const BodyPose pose = PoseFromAxisAngle(model, values, Vector3d::Zero());
  EXPECT_LT((pose.rotations[22] - RotationFromAxisAngle(values.segment<3>(66) + Vector3d(0.1, 0.2, 0.3))).norm(),
            1e-15);
  EXPECT_LT((AxisAngleFromPose(model, pose) - values).norm(), 1e-13);
  // Values that end before the hands leave the hands at their mean.
  const BodyPose body = PoseFromAxisAngle(model, values.head(66), Vector3d::Zero());
  EXPECT_LT((body.rotations[23] - RotationFromAxisAngle({-0.1, 0.4, 0.2})).norm(), 1e-15);
}

TEST(PosedBody, BadPosesAreRefused) {
  const BodyModel& model = ToyBody();
  const auto message = [&](const VectorXd& values, const Vector3d& trans) -> std::string {
    try {
      PoseFromAxisAngle(model, values, trans);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "accepted";
  };
  EXPECT_THAT(message(VectorXd::Zero(75), Vector3d::Zero()),
              HasSubstr("pose has 75 values, the body 'toy' takes 3J = 72"));
  EXPECT_THAT(message(VectorXd::Zero(71), Vector3d::Zero()), HasSubstr("pose has 71 values"));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message(VectorXd::Constant(72, nan), Vector3d::Zero()), HasSubstr("NaN"));
  EXPECT_THAT(message(VectorXd::Zero(72), Vector3d(0, nan, 0)), HasSubstr("NaN"));
  BodyPose short_pose = RestPose(model);
  short_pose.rotations.pop_back();
  EXPECT_THROW(PoseVertices(model, VectorXd(), short_pose), std::invalid_argument);
  EXPECT_THROW(PoseSkeleton(model, MatrixX3d::Zero(23, 3), RestPose(model)), std::invalid_argument);
}

TEST(PosedBody, SmoothEnoughForDifferenceQuotients) {
  // Double throughout: a step of 1e-6 in a beta or an angle moves vertices by what the derivative says.
  const BodyModel& model = ToyBody();
  const VectorXd betas = RandomBetas(6, 8);
  const BodyPose pose = RandomPose(model, 11);
  const double h = 1e-6;
  const MatrixX3d base = PoseVertices(model, betas, pose);
  for (int b = 0; b < 6; ++b) {
    const MatrixX3d once = PoseVertices(model, betas + h * VectorXd::Unit(6, b), pose) - base;
    const MatrixX3d twice = PoseVertices(model, betas + 2 * h * VectorXd::Unit(6, b), pose) - base;
    EXPECT_GT(once.norm(), 0.01 * h);
    EXPECT_LT((twice - 2 * once).cwiseAbs().maxCoeff(), 1e-14);  // linear in shape
  }
  BodyPose turned = pose;
  turned.rotations[18] = pose.rotations[18] * RotationFromAxisAngle({h, 0, 0});
  const MatrixX3d once = PoseVertices(model, betas, turned) - base;
  turned.rotations[18] = pose.rotations[18] * RotationFromAxisAngle({-h, 0, 0});
  const MatrixX3d back = PoseVertices(model, betas, turned) - base;
  EXPECT_GT(once.norm(), h * 0.1);
  EXPECT_LT((once + back).cwiseAbs().maxCoeff(), 1e-11);
}

}  // namespace
}  // namespace bodyloom::posed_body_test
