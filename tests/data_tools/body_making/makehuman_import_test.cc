// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "bodyloom/data_tools/body_making/import_makehuman.h"
#include "bodyloom/geometry/observations.h"
#include "tests/data_tools/body_making/mini_makehuman.h"
#include "tests/data_tools/body_making/recipe_support.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/paths.h"

namespace bodyloom {
namespace {

ImportMakeHumanOptions FewPeople(int num_people) {
  ImportMakeHumanOptions options;
  options.num_people = num_people;
  return options;
}

Eigen::RowVector3d Bone(const BodyModel& body, const std::string& from, const std::string& to) {
  return (body.joint_template().row(body.FindJoint(to)) - body.joint_template().row(body.FindJoint(from))).normalized();
}

/// What every imported body must have.
void ExpectTPoseBody(const BodyModel& body) {
  EXPECT_EQ(body.parents(), SmplParents());
  EXPECT_LT(body.joint_template().row(0).norm(), 0.003) << "pelvis at the origin";
  EXPECT_GT(Bone(body, "l_shoulder", "l_elbow").x(), 0.9999);
  EXPECT_GT(Bone(body, "l_elbow", "l_wrist").x(), 0.9999);
  EXPECT_LT(Bone(body, "r_shoulder", "r_elbow").x(), -0.9999);
  EXPECT_GT(Bone(body, "l_wrist", "l_hand").x(), 0.999);
  EXPECT_LT(Bone(body, "l_hip", "l_knee").y(), -0.98);
  EXPECT_GT(Bone(body, "l_ankle", "l_foot").z(), 0.4);
  for (int v = 0; v < body.num_vertices(); ++v) {
    const int begin = body.influence_begin()[v], end = body.influence_begin()[v + 1];
    EXPECT_TRUE(end - begin >= 1 && end - begin <= 4) << "vertex " << v;
  }
  for (int j = 0; j < 24; ++j) {
    for (SparseRows::InnerIterator it(body.data().J_regressor, j); it; ++it) EXPECT_GT(it.value(), 0);
  }
  std::vector<std::string> names = CocoNames();
  for (const char* point : {"big_toe", "small_toe", "heel"}) {
    for (const char* side : {"left_", "right_"}) names.push_back(std::string(side) + point);
  }
  ASSERT_EQ(body.data().landmarks.size(), names.size());
  for (size_t i = 0; i < names.size(); ++i) EXPECT_EQ(body.data().landmarks[i].name, names[i]);
  EXPECT_TRUE(body.has_uv());
  EXPECT_GE(body.data().vt.minCoeff(), 0);
  EXPECT_LE(body.data().vt.maxCoeff(), 1);
  EXPECT_GT(MeshVolume(body.data().v_template, body.data().faces), 0) << "faces look outwards";
}

TEST(MakeHumanImport, BodyOfBoxes) {
  const TemporaryFolder folder;
  MiniMakeHuman mini(folder.File("makehuman"));
  mini.Write();
  ImportMakeHumanSummary summary;
  ImportMakeHumanOptions options = FewPeople(40);
  options.num_betas = 3;
  const BodyModel body(ImportMakeHuman(mini.folder(), options, &summary));
  EXPECT_EQ(body.name(), "makehuman");
  EXPECT_EQ(body.num_vertices(), 8 * (MiniMakeHuman::kNumBones - 1));
  EXPECT_EQ(body.num_faces(), 12 * (MiniMakeHuman::kNumBones - 1));
  EXPECT_EQ(body.num_betas(), 3);
  EXPECT_EQ(body.data().vt.rows(), 4) << "unused texture coordinates are left out";
  EXPECT_EQ(summary.targets, 6);
  ASSERT_EQ(summary.cumulative_variance.size(), 3u);
  // The targets are scalings: few directions explain all.
  EXPECT_GT(summary.cumulative_variance[2], 0.99);
  ExpectTPoseBody(body);
  // A person of beta 0 grows taller with beta 0 > 0 by the sign convention.
  EXPECT_GT(ShapeVertices(body, Eigen::Vector3d(2, 0, 0)).col(1).maxCoeff(), body.data().v_template.col(1).maxCoeff());
  // The forearm bends forwards about −y on the left.
  Eigen::VectorXd pose = Eigen::VectorXd::Zero(72);
  pose[3 * 18 + 1] = -std::numbers::pi / 2;
  const PosedSkeleton skeleton =
      PoseSkeleton(body, body.joint_template(), PoseFromAxisAngle(body, pose, Eigen::Vector3d::Zero()));
  EXPECT_GT((skeleton.joints.row(20) - skeleton.joints.row(18)).normalized().z(), 0.999);
}

TEST(MakeHumanImport, SameInputSameBody) {
  const TemporaryFolder folder;
  MiniMakeHuman mini(folder.File("makehuman"));
  mini.Write();
  ImportMakeHumanOptions options = FewPeople(25);
  options.num_betas = 2;
  const BodyModelData a = ImportMakeHuman(mini.folder(), options), b = ImportMakeHuman(mini.folder(), options);
  EXPECT_EQ(a.v_template, b.v_template);
  EXPECT_EQ(a.shapedirs, b.shapedirs);
  options.seed = 2;
  EXPECT_NE(ImportMakeHuman(mini.folder(), options).v_template, a.v_template);
}

TEST(MakeHumanImport, RefusesInvalidOptions) {
  EXPECT_THROW(ImportMakeHuman("/nowhere", FewPeople(19)), std::invalid_argument);
  ImportMakeHumanOptions options = FewPeople(30);
  options.num_betas = 30;
  EXPECT_THROW(ImportMakeHuman("/nowhere", options), std::invalid_argument);
  options = {};
  options.metres_per_unit = std::nan("");
  EXPECT_THROW(ImportMakeHuman("/nowhere", options), std::invalid_argument);
}

/// The true assets, where they are at hand.
class MakeHumanAssets : public testing::Test {
 protected:
  void SetUp() override {
    const std::string folder = SharedDir() + "/data/makehuman";
    if (!std::filesystem::exists(folder + "/base.obj")) GTEST_SKIP() << "MakeHuman's assets are not at " << folder;
    if (body_ == nullptr) body_ = new BodyModel(ImportMakeHuman(folder, FewPeople(100), &summary_));
  }
  static inline const BodyModel* body_ = nullptr;
  static inline ImportMakeHumanSummary summary_;
};

TEST_F(MakeHumanAssets, Sizes) {
  EXPECT_EQ(body_->num_vertices(), 13380);
  EXPECT_EQ(body_->num_faces(), 2 * 13378);
  EXPECT_EQ(body_->num_betas(), 10);
  EXPECT_EQ(summary_.targets, 192);
  ExpectTPoseBody(*body_);
}

TEST_F(MakeHumanAssets, HeightsArePlausible) {
  EXPECT_NEAR(summary_.mean_height_m, 1.66, 0.02);
  const auto height = [&](double beta) {
    const MatrixX3d v = ShapeVertices(*body_, OneBeta(0, beta));
    return v.col(1).maxCoeff() - v.col(1).minCoeff();
  };
  EXPECT_NEAR(height(2), 1.83, 0.05);
  EXPECT_NEAR(height(-2), 1.48, 0.05);
  EXPECT_GT(summary_.cumulative_variance[0], 0.7);
  EXPECT_GT(summary_.cumulative_variance[9], 0.985);
  const double volume_l = 1000 * MeshVolume(body_->data().v_template, body_->data().faces);
  EXPECT_NEAR(volume_l, 62, 5);
}

TEST_F(MakeHumanAssets, JointsLieInsideTheBody) {
  // Winding number; the mouth and the eye sockets turn inwards, but no joint lies in them.
  for (double beta : {0.0, 2.0, -2.0}) {
    const MatrixX3d v = ShapeVertices(*body_, OneBeta(0, beta));
    const MatrixX3d joints = body_->RestJoints(OneBeta(0, beta));
    for (int j = 0; j < 24; ++j) {
      double solid_angle = 0;
      for (Eigen::Index f = 0; f < body_->num_faces(); ++f) {
        const Eigen::Vector3d a = v.row(body_->data().faces(f, 0)) - joints.row(j);
        const Eigen::Vector3d b = v.row(body_->data().faces(f, 1)) - joints.row(j);
        const Eigen::Vector3d c = v.row(body_->data().faces(f, 2)) - joints.row(j);
        const double na = a.norm(), nb = b.norm(), nc = c.norm();
        solid_angle += 2 * std::atan2(a.cross(b).dot(c), na * nb * nc + a.dot(b) * nc + b.dot(c) * na + c.dot(a) * nb);
      }
      EXPECT_NEAR(solid_angle / (4 * std::numbers::pi), 1, 0.01) << SmplJointNames()[j] << " beta " << beta;
    }
  }
}

TEST_F(MakeHumanAssets, JointsFollowTheRig) {
  // SMPL's joints sit at the rig's; the spine's scatter most (the rig's cubes wander relative to the skin).
  for (int j = 0; j < 24; ++j)
    EXPECT_LT(summary_.joint_errors_mm[j], j == 9 ? 22 : j == 6 ? 17 : 11) << SmplJointNames()[j];
  // Proportions like those of the built-in body, which was measured on the same assets.
  const double scale = summary_.mean_height_m / 1.712;
  for (int j = 0; j < 24; ++j) {
    EXPECT_LT((body_->joint_template().row(j) - scale * BuiltinBody().joint_template().row(j)).norm(), 0.025)
        << SmplJointNames()[j];
  }
}

TEST_F(MakeHumanAssets, BendsKeepTheVolume) {
  const double rest = MeshVolume(body_->data().v_template, body_->data().faces);
  for (const auto& [joint, axis, degrees] :
       {std::tuple{18, 1, -90.0}, {19, 1, 90.0}, {4, 0, 90.0}, {5, 0, 90.0}, {16, 2, -70.0}, {17, 2, 70.0}}) {
    Eigen::VectorXd pose = Eigen::VectorXd::Zero(72);
    pose[3 * joint + axis] = degrees * std::numbers::pi / 180;
    const MatrixX3d v = PoseVertices(*body_, {}, PoseFromAxisAngle(*body_, pose, Eigen::Vector3d::Zero()));
    EXPECT_NEAR(MeshVolume(v, body_->data().faces) / rest, 1, 0.015) << SmplJointNames()[joint];
  }
}

TEST_F(MakeHumanAssets, Landmarks) {
  const auto point = [&](const char* name) {
    const Landmark& landmark = body_->data().landmarks[body_->FindLandmark(name)];
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (size_t i = 0; i < landmark.vertices.size(); ++i) {
      sum += landmark.weights[i] * body_->data().v_template.row(landmark.vertices[i]);
    }
    return sum;
  };
  EXPECT_NEAR(point("nose").x(), 0, 0.002);
  EXPECT_GT(point("nose").z(), point("left_eye").z());
  EXPECT_NEAR(point("left_eye").x() - point("right_eye").x(), 0.06, 0.01);
  EXPECT_GT(point("left_eye").y(), point("nose").y() + 0.02);
  EXPECT_NEAR(point("left_ear").x() - point("right_ear").x(), 0.165, 0.03);
  EXPECT_GT(point("left_ear").y(), point("nose").y() - 0.04);
  EXPECT_LT(point("left_ear").y(), point("left_eye").y() + 0.03);
  EXPECT_GT(point("left_big_toe").z(), point("left_small_toe").z() + 0.01);
  EXPECT_GT(point("left_small_toe").x(), point("left_big_toe").x() + 0.03);
  EXPECT_LT(point("left_heel").z(), point("left_ankle").z() - 0.02);
  EXPECT_LT(point("left_heel").y(), point("left_ankle").y());
}

}  // namespace
}  // namespace bodyloom
