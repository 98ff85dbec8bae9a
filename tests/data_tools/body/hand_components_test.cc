// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body/hand_components.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "data_tools/body/body_io.h"
#include "data_tools/formats/atomic_file.h"
#include "geometry/body/hand_skeleton.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "tests/data_tools/body/small_body.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/pickle_writer.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::hand_components_test {
namespace {

using testing::HasSubstr;

constexpr int kValues = 45;

/// Orthonormal rows: a Householder reflection that differs from side to side.
RowMatrixXd Components(int side) {
  Eigen::VectorXd u(kValues);
  for (int i = 0; i < kValues; ++i) u[i] = std::sin(1.0 + i * (side + 1));
  u.normalize();
  return Eigen::MatrixXd::Identity(kValues, kValues) - 2 * u * u.transpose();
}

NpzArrays SmplhFile() {
  NpzArrays arrays = OfficialNpz(MakeBodyArrays(80, 52, 16, false));
  for (int side = 0; side < 2; ++side) {
    const RowMatrixXd components = Components(side);
    arrays[side == 0 ? "hands_componentsl" : "hands_componentsr"] =
        NdArray::FromDoubles(components.data(), {kValues, kValues});
  }
  return arrays;
}

TEST(HandComponents, OfSmplhAndSmplxFiles) {
  const TemporaryFolder folder;
  const std::string path = folder.File("smplh.npz");
  WriteNpz(path, SmplhFile());
  const auto hands = LoadHandComponents(path);
  ASSERT_TRUE(hands.has_value());
  const BodyArrays expected = MakeBodyArrays(80, 52, 16, false);
  for (int side = 0; side < 2; ++side) {
    const HandComponents& hand = (*hands)[side];
    EXPECT_EQ(hand.components, Components(side));
    for (int i = 0; i < kValues; ++i) EXPECT_EQ(hand.mean[i], expected.hands_mean[side][i]);
    // smplx: hand_pose = einsum('bi,ij->bj', coefficients, components), the mean added to the full pose.
    const Eigen::VectorXd coefficients = Eigen::VectorXd::LinSpaced(6, -1, 1.5);
    Eigen::VectorXd pose = Eigen::VectorXd::Zero(kValues);
    for (int j = 0; j < kValues; ++j) {
      for (int i = 0; i < 6; ++i) pose[j] += coefficients[i] * Components(side)(i, j);
    }
    EXPECT_LT((hand.Pose(coefficients, true) - pose).norm(), 1e-14);
    EXPECT_LT((hand.Pose(coefficients) - pose - hand.mean).norm(), 1e-14);
    EXPECT_LT((hand.Coefficients(hand.Pose(coefficients), 6) - coefficients).norm(), 1e-12);
    EXPECT_LT((hand.Coefficients(pose, 12, true).head(6) - coefficients).norm(), 1e-12);
  }
}

TEST(HandComponents, PosesABodyAsItsMeanHandDoes) {
  // The body's pose_mean holds the mean hand: PCA coefficients without it give the same rotations as with it on a body
  // whose hands are flat at zero.
  const TemporaryFolder folder;
  const std::string path = folder.File("smplh.npz");
  WriteNpz(path, SmplhFile());
  const auto hands = LoadHandComponents(path);
  const BodyModel relaxed = LoadBody(path);
  const BodyModel flat = LoadBody(path, {.max_betas = 0, .flat_hand_mean = true});
  Eigen::VectorXd relative = Eigen::VectorXd::Zero(156), absolute = relative;
  const Eigen::VectorXd coefficients = Eigen::VectorXd::LinSpaced(12, 0.5, -0.5);
  for (int side = 0; side < 2; ++side) {
    relative.segment(66 + 45 * side, 45) = (*hands)[side].Pose(coefficients, true);
    absolute.segment(66 + 45 * side, 45) = (*hands)[side].Pose(coefficients);
  }
  const BodyPose a = PoseFromAxisAngle(relaxed, relative, Eigen::Vector3d::Zero());
  const BodyPose b = PoseFromAxisAngle(flat, absolute, Eigen::Vector3d::Zero());
  for (int j = 0; j < 52; ++j) EXPECT_LT((a.rotations[j] - b.rotations[j]).norm(), 1e-12) << j;
}

TEST(HandComponents, MissingOnesAndGarbage) {
  const TemporaryFolder folder;
  const std::string path = folder.File("body.npz");
  WriteNpz(path, OfficialNpz(MakeBodyArrays(60, 24, 3, false)));
  EXPECT_FALSE(LoadHandComponents(path).has_value());
  WriteFileAtomically(folder.File("smpl.pkl"), OfficialPickle(MakeBodyArrays(60, 24, 3, false)));
  EXPECT_FALSE(LoadHandComponents(folder.File("smpl.pkl")).has_value());
  const auto error = [&](const std::string& key, const NdArray& array) {
    NpzArrays arrays = SmplhFile();
    arrays[key] = array;
    WriteNpz(path, arrays);
    return FileErrorOf(path, [&] { LoadHandComponents(path); });
  };
  std::vector<double> zeros(46 * 45, 0.0);
  EXPECT_THAT(error("hands_componentsl", NdArray::FromDoubles(zeros.data(), {45, 44})), HasSubstr("expected nx45"));
  EXPECT_THAT(error("hands_componentsr", NdArray::FromDoubles(zeros.data(), {46, 45})), HasSubstr("expected 1 to 45"));
  EXPECT_THAT(error("hands_componentsr", NdArray::FromString("none")), HasSubstr("hands_componentsr"));
  EXPECT_THAT(error("hands_meanl", NdArray::FromDoubles(zeros.data(), {44})), HasSubstr("hands_meanl"));
  zeros[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(error("hands_componentsl", NdArray::FromDoubles(zeros.data(), {45, 45})), HasSubstr("NaN"));
  EXPECT_THAT(error("hands_meanr", NdArray::FromDoubles(zeros.data(), {45})), HasSubstr("NaN"));
  WriteFileAtomically(path, "garbage");
  EXPECT_FALSE(FileErrorOf(path, [&] { LoadHandComponents(path); }).empty());
  EXPECT_THROW(HandComponents().Pose(Eigen::VectorXd::Zero(1)), std::invalid_argument);
}

TEST(HandComponents, SmplhTopologyGetsTheHandsLandmarks) {
  for (const auto& [V, J, tip] : {std::tuple{6890, 52, 2319}, std::tuple{10475, 55, 4933}}) {
    const TemporaryFolder folder;
    WriteNpz(folder.File("body.npz"), OfficialNpz(MakeBodyArrays(V, J, 2, false)));
    const BodyModel body = LoadBody(folder.File("body.npz"));
    EXPECT_EQ(body.data().landmarks.size(), 63U);
    EXPECT_EQ(body.data().landmarks[body.FindLandmark("left_index_tip")].vertices, std::vector<int>{tip});
    BodyPose pose;
    pose.rotations.assign(size_t(J), Eigen::Matrix3d::Identity());
    const MatrixX3d points = PoseLandmarks(body, {}, pose, {"right_thumb_mcp", "left_pinky_dip"});
    EXPECT_TRUE(points.row(0).isApprox(body.joint_template().row(body.FindJoint("r_thumb2")), 1e-9));
    EXPECT_TRUE(points.row(1).isApprox(body.joint_template().row(body.FindJoint("l_pinky3")), 1e-9));
  }
}

}  // namespace
}  // namespace bodyloom::hand_components_test
