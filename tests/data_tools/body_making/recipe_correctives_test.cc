// SPDX-License-Identifier: Apache-2.0
/// Promises of assets/body/RECIPE.md, section 7: pose correctives.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "geometry/math/rotation.h"
#include "tests/data_tools/body_making/recipe_support.h"

namespace bodyloom::recipe_correctives_test {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// A rotation of some joints, by name, in degrees about an axis of the body frame.
using Pose = std::vector<std::pair<const char*, Eigen::Vector3d>>;

BodyPose MakePose(const Pose& pose) {
  Eigen::VectorXd axis_angle = Eigen::VectorXd::Zero(72);
  for (const auto& [joint, degrees] : pose) {
    axis_angle.segment<3>(3 * BuiltinBody().FindJoint(joint)) = kDegree * degrees;
  }
  return PoseFromAxisAngle(BuiltinBody(), axis_angle, Eigen::Vector3d::Zero());
}

const BodyModel& BodyWithoutCorrectives() {
  static const BodyModel body = [] {
    BodyModelData data = BuiltinBody().data();
    data.posedirs = {};
    return BodyModel(std::move(data));
  }();
  return body;
}

double VolumeKept(const BodyModel& body, const BodyPose& pose) {
  const MatrixX3i& faces = body.data().faces;
  return MeshVolume(PoseVertices(body, {}, pose), faces) / MeshVolume(body.data().v_template, faces);
}

TEST(RecipeCorrectives, SparseAndRounded) {
  const PoseCorrectives& correctives = BuiltinBody().data().posedirs;
  int64_t nonzero = 0;
  double largest = 0;
  for (float value : correctives.block) {
    nonzero += value != 0;
    largest = std::max(largest, std::abs(static_cast<double>(value)));
    const double steps = value / 5e-5;
    ASSERT_NEAR(steps, std::round(steps), 1e-3) << "multiples of 0.05 mm";
  }
  const double share = static_cast<double>(nonzero) / (7874.0 * 3 * 207);
  EXPECT_NEAR(share, 0.053, 0.0005);
  EXPECT_NEAR(largest, 0.0399, 0.0001);
  int vertices = 0;
  for (size_t v = 0; v + 1 < correctives.begin.size(); ++v) vertices += correctives.begin[v + 1] > correctives.begin[v];
  EXPECT_EQ(vertices, 6445);
  EXPECT_EQ(correctives.joint.size(), 10322u);
  for (size_t b = 0; b < correctives.joint.size(); ++b) {
    const auto block = Eigen::Map<const Eigen::Matrix<float, 27, 1>>(&correctives.block[27 * b]);
    EXPECT_GE(block.cwiseAbs().maxCoeff(), 0.00025f - 1e-7f) << "a block without an entry of 0.25 mm";
  }
  EXPECT_EQ(std::set<int>(correctives.joint.begin(), correctives.joint.end()).size(), 23u);
}

TEST(RecipeCorrectives, MirroredPoseGivesMirroredBody) {
  const BodyModel& body = BuiltinBody();
  const std::vector<int> mirror = MirrorByPosition(body.data().v_template);
  std::mt19937 random(11);
  std::normal_distribution<double> angle(0, 0.5);
  for (int trial = 0; trial < 5; ++trial) {
    Eigen::VectorXd pose(72), mirrored(72);
    for (int i = 0; i < 72; ++i) pose[i] = angle(random);
    for (int j = 0; j < 24; ++j) {  // S R S has the axis-angle (x, −y, −z)
      mirrored.segment<3>(3 * MirrorJoint(body, j)) = pose.segment<3>(3 * j).cwiseProduct(Eigen::Vector3d(1, -1, -1));
    }
    const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
    const MatrixX3d a = PoseVertices(body, {}, PoseFromAxisAngle(body, pose, zero));
    const MatrixX3d b = PoseVertices(body, {}, PoseFromAxisAngle(body, mirrored, zero));
    for (int v = 0; v < body.num_vertices(); ++v) {
      ASSERT_LT((b.row(mirror[v]) - a.row(v).cwiseProduct(Eigen::RowVector3d(-1, 1, 1))).norm(), 1e-8)
          << "vertex " << v;
    }
  }
}

TEST(RecipeCorrectives, VolumeKeptUnderBends) {
  struct Row {
    const char* name;
    Pose pose;
    double lbs, corrected;
  };
  const Row rows[] = {
      {"one knee 90", {{"l_knee", {90, 0, 0}}}, .996, 1.000},
      {"both knees 90", {{"l_knee", {90, 0, 0}}, {"r_knee", {90, 0, 0}}}, .991, 1.001},
      {"hip and knee 90", {{"l_hip", {-90, 0, 0}}, {"l_knee", {90, 0, 0}}}, .961, .989},
      {"squat",
       {{"l_hip", {-100, 0, 0}}, {"r_hip", {-100, 0, 0}}, {"l_knee", {110, 0, 0}}, {"r_knee", {110, 0, 0}}},
       .914,
       .974},
      {"both elbows 120", {{"l_elbow", {0, -120, 0}}, {"r_elbow", {0, 120, 0}}}, .993, .996},
      {"arms down", {{"l_shoulder", {0, 0, -75}}, {"r_shoulder", {0, 0, 75}}}, .981, .985},
      {"arms overhead", {{"l_shoulder", {0, 0, 80}}, {"r_shoulder", {0, 0, -80}}}, 1.004, 1.020},
  };
  for (const Row& row : rows) {
    const BodyPose pose = MakePose(row.pose);
    EXPECT_NEAR(VolumeKept(BodyWithoutCorrectives(), pose), row.lbs, 0.0006) << row.name;
    EXPECT_NEAR(VolumeKept(BuiltinBody(), pose), row.corrected, 0.0006) << row.name;
  }
}

/// Dual-quaternion skinning of the template (Kavan et al. 2007), the correctives' model.
MatrixX3d DualQuaternionVertices(const BodyModel& body, const BodyPose& pose) {
  const PosedSkeleton skeleton = PoseSkeleton(body, body.joint_template(), pose);
  std::vector<Eigen::Vector4d> real(24), dual(24);  // x y z w
  for (int j = 0; j < 24; ++j) {
    const Eigen::Quaterniond q(skeleton.world_rotations[j]);
    const Eigen::Vector3d t =
        skeleton.joints.row(j).transpose() - skeleton.world_rotations[j] * skeleton.rest_joints.row(j).transpose();
    real[j] = q.coeffs();
    dual[j] = 0.5 * (Eigen::Quaterniond(0, t.x(), t.y(), t.z()) * q).coeffs();
  }
  MatrixX3d vertices(body.num_vertices(), 3);
  for (int v = 0; v < body.num_vertices(); ++v) {
    int pivot = -1;
    double maximum = 0;
    for (SparseRows::InnerIterator it(body.data().weights, v); it; ++it) {
      if (it.value() > maximum) {
        maximum = it.value();
        pivot = static_cast<int>(it.col());
      }
    }
    Eigen::Vector4d b = Eigen::Vector4d::Zero(), e = Eigen::Vector4d::Zero();
    for (SparseRows::InnerIterator it(body.data().weights, v); it; ++it) {
      const double w = real[it.col()].dot(real[pivot]) < 0 ? -it.value() : it.value();
      b += w * real[it.col()];
      e += w * dual[it.col()];
    }
    const double norm = b.norm();
    const Eigen::Quaterniond q(Eigen::Vector4d(b / norm));
    const Eigen::Quaterniond t(Eigen::Vector4d(e / norm));
    const Eigen::Vector3d translation = 2 * (t * q.conjugate()).vec();
    vertices.row(v) = (q * Eigen::Vector3d(body.data().v_template.row(v)) + translation).transpose();
  }
  return vertices;
}

TEST(RecipeCorrectives, ApproachDualQuaternions) {
  const BodyModel& body = BuiltinBody();
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  // Standard deviations, radians: limbs 0.45, spine and head 0.15, hands and feet 0.2.
  const auto spread = [](const std::string& joint) {
    for (const char* limb : {"hip", "knee", "shoulder", "elbow"}) {
      if (joint.ends_with(limb)) return 0.45;
    }
    return joint.ends_with("wrist") || joint.ends_with("ankle") ? 0.2 : 0.15;
  };
  std::vector<double> lbs_mm, corrected_mm;
  for (int trial = 0; trial < 40; ++trial) {
    Eigen::VectorXd axis_angle = Eigen::VectorXd::Zero(72);
    for (int j = 1; j < 22; ++j) {
      for (int c = 0; c < 3; ++c) axis_angle[3 * j + c] = spread(SmplJointNames()[j]) * normal(random);
    }
    const BodyPose pose = PoseFromAxisAngle(body, axis_angle, Eigen::Vector3d::Zero());
    const MatrixX3d target = DualQuaternionVertices(body, pose);
    const MatrixX3d lbs = PoseVertices(BodyWithoutCorrectives(), {}, pose), corrected = PoseVertices(body, {}, pose);
    for (int v = 0; v < body.num_vertices(); ++v) {
      if (body.data().posedirs.begin[v] == body.data().posedirs.begin[v + 1]) continue;
      lbs_mm.push_back(1000 * (lbs.row(v) - target.row(v)).norm());
      corrected_mm.push_back(1000 * (corrected.row(v) - target.row(v)).norm());
    }
  }
  const auto mean = [](const std::vector<double>& x) {
    return Eigen::Map<const Eigen::VectorXd>(x.data(), x.size()).mean();
  };
  const auto p95 = [](std::vector<double> x) {
    std::nth_element(x.begin(), x.begin() + x.size() * 95 / 100, x.end());
    return x[x.size() * 95 / 100];
  };
  RecordProperty("lbs_mean_mm", std::to_string(mean(lbs_mm)));
  RecordProperty("lbs_p95_mm", std::to_string(p95(lbs_mm)));
  RecordProperty("corrected_mean_mm", std::to_string(mean(corrected_mm)));
  RecordProperty("corrected_p95_mm", std::to_string(p95(corrected_mm)));
  EXPECT_LT(mean(corrected_mm), 0.5 * mean(lbs_mm));
  EXPECT_LT(p95(corrected_mm), 0.5 * p95(lbs_mm));
}

}  // namespace
}  // namespace bodyloom::recipe_correctives_test
