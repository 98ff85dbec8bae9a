// SPDX-License-Identifier: Apache-2.0
/// Promises of assets/body/RECIPE.md, sections 4, 6 and 7: joints, regressor, landmarks, skinning weights.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry/scene/observations.h"
#include "tests/data_tools/body_making/recipe_support.h"

namespace bodyloom::recipe_joints_test {
namespace {

Eigen::RowVector3d Joint(const std::string& name) {
  return BuiltinBody().joint_template().row(BuiltinBody().FindJoint(name));
}

double DegreesBetween(const Eigen::RowVector3d& a, const Eigen::RowVector3d& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0)) * 180 / std::numbers::pi;
}

TEST(RecipeJoints, SmplTree) {
  EXPECT_EQ(BuiltinBody().parents(), SmplParents());
  EXPECT_EQ(BuiltinBody().data().joint_names, SmplJointNames());
}

TEST(RecipeJoints, TPose) {
  // Arms along ±x within a degree, legs down, everything symmetric.
  EXPECT_LT(DegreesBetween(Joint("l_elbow") - Joint("l_shoulder"), {1, 0, 0}), 0.5);
  EXPECT_LT(DegreesBetween(Joint("l_wrist") - Joint("l_elbow"), {1, 0, 0}), 0.5);
  EXPECT_LT(DegreesBetween(Joint("l_hand") - Joint("l_wrist"), {1, 0, 0}), 2);
  // The directions are those of the fit before the population mean was added: within a few degrees.
  EXPECT_LT(DegreesBetween(Joint("l_knee") - Joint("l_hip"), {.045, -1, -.02}), 5);
  EXPECT_LT(DegreesBetween(Joint("l_ankle") - Joint("l_knee"), {.035, -1, -.03}), 1);
  for (int j = 0; j < 24; ++j) {
    const int other = MirrorJoint(BuiltinBody(), j);
    const Eigen::RowVector3d mirrored =
        BuiltinBody().joint_template().row(other).cwiseProduct(Eigen::RowVector3d(-1, 1, 1));
    EXPECT_LT((BuiltinBody().joint_template().row(j) - mirrored).norm(), 1e-9) << SmplJointNames()[j];
  }
}

TEST(RecipeJoints, Offsets) {
  const double pelvis = Joint("pelvis").y();
  EXPECT_NEAR(Joint("l_hip").y() - pelvis, -0.081, 0.002);
  EXPECT_NEAR(Joint("spine1").y() - pelvis, 0.118, 0.001);
  EXPECT_NEAR(Joint("spine2").y() - pelvis, 0.250, 0.001);
  EXPECT_NEAR(Joint("spine3").y() - pelvis, 0.309, 0.001);
  EXPECT_NEAR(Joint("neck").y() - pelvis, 0.493, 0.001);
  EXPECT_NEAR(Joint("head").y() - pelvis, 0.594, 0.001);
}

TEST(RecipeJoints, Proportions) {
  const auto length = [](const char* a, const char* b) { return (Joint(a) - Joint(b)).norm(); };
  const double thigh = length("l_hip", "l_knee"), shank = length("l_knee", "l_ankle");
  const double arm = length("l_shoulder", "l_elbow") + length("l_elbow", "l_wrist");
  EXPECT_NEAR(shank / thigh, 1.068, 0.002);
  EXPECT_NEAR(arm / (thigh + shank), 0.630, 0.002);
}

TEST(RecipeJoints, RegressorRows) {
  const SparseRows& regressor = BuiltinBody().data().J_regressor;
  const int expected_entries[24] = {41, 22, 22, 38,  68, 68, 26, 78, 78,  23,  79,  79,
                                    42, 33, 33, 119, 64, 64, 65, 65, 132, 132, 203, 203};
  for (int j = 0; j < 24; ++j) {
    double sum = 0;
    int entries = 0;
    for (SparseRows::InnerIterator it(regressor, j); it; ++it) {
      EXPECT_GT(it.value(), 0);
      sum += it.value();
      ++entries;
    }
    EXPECT_NEAR(sum, 1, 1e-6);
    EXPECT_EQ(entries, expected_entries[j]) << SmplJointNames()[j];
    EXPECT_GE(entries, 22);
    EXPECT_LE(entries, 203);
  }
}

TEST(RecipeJoints, JointsLieInsideTheBodyOfEveryShape) {
  // Winding number of the mesh around each joint, by the solid angles of its triangles.
  const BodyModel& body = BuiltinBody();
  for (const Eigen::VectorXd& betas : {OneBeta(0, 0), OneBeta(0, 2), OneBeta(0, -2), OneBeta(2, 2), OneBeta(2, -2)}) {
    const MatrixX3d v = ShapeVertices(body, betas);
    const MatrixX3d joints = body.RestJoints(betas);
    for (int j = 0; j < 24; ++j) {
      double solid_angle = 0;
      for (Eigen::Index f = 0; f < body.num_faces(); ++f) {
        const Eigen::Vector3d a = v.row(body.data().faces(f, 0)) - joints.row(j);
        const Eigen::Vector3d b = v.row(body.data().faces(f, 1)) - joints.row(j);
        const Eigen::Vector3d c = v.row(body.data().faces(f, 2)) - joints.row(j);
        const double na = a.norm(), nb = b.norm(), nc = c.norm();
        solid_angle += 2 * std::atan2(a.cross(b).dot(c), na * nb * nc + a.dot(b) * nc + b.dot(c) * na + c.dot(a) * nb);
      }
      EXPECT_NEAR(solid_angle / (4 * std::numbers::pi), 1, 1e-6) << SmplJointNames()[j];
    }
  }
}

TEST(RecipeJoints, Landmarks) {
  const BodyModel& body = BuiltinBody();
  std::vector<std::string> names = CocoNames();
  for (const char* point : {"big_toe", "small_toe", "heel"}) {
    names.push_back(std::string("left_") + point);
    names.push_back(std::string("right_") + point);
  }
  ASSERT_EQ(body.data().landmarks.size(), names.size());
  for (size_t i = 0; i < names.size(); ++i) {
    const Landmark& landmark = body.data().landmarks[i];
    EXPECT_EQ(landmark.name, names[i]);
    double sum = 0;
    for (double weight : landmark.weights) {
      EXPECT_GT(weight, 0);
      sum += weight;
    }
    EXPECT_NEAR(sum, 1, 1e-6) << names[i];
  }
  const MatrixX3d points = PoseLandmarks(body, {}, PoseFromAxisAngle(body, Eigen::VectorXd(), {0, 0, 0}), names);
  // COCO's elbows, wrists and knees are the joints.
  for (const auto& [landmark, joint] : {std::pair{"left_elbow", "l_elbow"},
                                        {"right_elbow", "r_elbow"},
                                        {"left_wrist", "l_wrist"},
                                        {"right_knee", "r_knee"}}) {
    EXPECT_LT((points.row(body.FindLandmark(landmark)) - Joint(joint)).norm(), 1e-6) << landmark;
  }
  // The others are mixtures with vertices of the cage (H03 is its fourth, H13 its twelfth, U23 its 44th) and the knee.
  const auto& v = body.data().v_template;
  const auto expect = [&](const char* landmark, const Eigen::RowVector3d& place) {
    EXPECT_LT((points.row(body.FindLandmark(landmark)) - place).norm(), 1e-6) << landmark;
  };
  expect("left_hip", 0.65 * Joint("l_hip") + 0.27 * v.row(3) + 0.08 * v.row(11));
  expect("left_shoulder", 0.8 * Joint("l_shoulder") + 0.2 * v.row(43));
  expect("left_ankle", 0.98 * Joint("l_ankle") + 0.02 * Joint("l_knee"));
  EXPECT_NEAR(points(body.FindLandmark("left_ankle"), 1) - v.col(1).minCoeff(), 0.081, 0.001);
  const Eigen::RowVector3d nose = points.row(body.FindLandmark("nose"));
  const Eigen::RowVector3d eye = points.row(body.FindLandmark("left_eye"));
  const Eigen::RowVector3d ear = points.row(body.FindLandmark("left_ear"));
  EXPECT_NEAR(nose.x(), 0, 1e-12);
  EXPECT_GT(nose.z(), eye.z());
  EXPECT_GT(eye.z(), ear.z());
  EXPECT_GT(eye.y(), nose.y());
  EXPECT_GT(ear.x(), eye.x());
  EXPECT_NEAR(2 * eye.x(), 0.063, 0.008) << "distance of the eyes, metres";
  EXPECT_GT(points(body.FindLandmark("left_big_toe"), 2), points(body.FindLandmark("left_small_toe"), 2));
  EXPECT_GT(points(body.FindLandmark("left_small_toe"), 0), points(body.FindLandmark("left_big_toe"), 0));
  EXPECT_LT(points(body.FindLandmark("left_heel"), 2), Joint("l_ankle").z());
  for (size_t i = 1; i + 1 < names.size(); i += 2) {
    EXPECT_LT((points.row(i).cwiseProduct(Eigen::RowVector3d(-1, 1, 1)) - points.row(i + 1)).norm(), 1e-9) << names[i];
  }
}

TEST(RecipeJoints, SkinningWeights) {
  const BodyModel& body = BuiltinBody();
  const std::vector<int> mirror = MirrorByPosition(body.data().v_template);
  const RowMatrixXd weights = body.data().weights;
  EXPECT_GE(weights.minCoeff(), 0);
  for (int v = 0; v < body.num_vertices(); ++v) {
    EXPECT_NEAR(weights.row(v).sum(), 1, 1e-12);
    EXPECT_LE((weights.row(v).array() > 0).count(), 4) << "vertex " << v;
    for (int j = 0; j < 24; ++j) EXPECT_NEAR(weights(v, j), weights(mirror[v], MirrorJoint(body, j)), 1e-15);
  }
  EXPECT_EQ((weights.array() > 0).colwise().any().count(), 24) << "every joint moves something";
}

}  // namespace
}  // namespace bodyloom::recipe_joints_test
