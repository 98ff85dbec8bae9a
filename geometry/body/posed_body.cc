// SPDX-License-Identifier: Apache-2.0
#include "geometry/body/posed_body.h"

#include <algorithm>
#include <numeric>

#include "geometry/base/check.h"
#include "geometry/body/hand_skeleton.h"
#include "geometry/math/rotation.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

BodyPose PoseFromAxisAngle(const BodyModel& model, const Eigen::Ref<const VectorXd>& axis_angle,
                           const Vector3d& trans) {
  const int J = model.num_joints();
  BODYLOOM_CHECK(axis_angle.size() <= 3 * J && axis_angle.size() % 3 == 0, "pose has ", axis_angle.size(),
                 " values, the body '", model.name(), "' takes 3J = ", 3 * J);
  BODYLOOM_CHECK(axis_angle.allFinite() && trans.allFinite(), "pose or translation holds NaN or infinite values");
  VectorXd full = model.data().pose_mean.size() > 0 ? model.data().pose_mean : VectorXd::Zero(3 * J);
  const auto smpl_values = static_cast<Eigen::Index>(3 * SmplJointNames().size());
  if (axis_angle.size() == smpl_values && J > axis_angle.size() / 3 && HasFingers(model)) {
    full.head(smpl_values - 6) += axis_angle.head(smpl_values - 6);
    for (const HandSide side : {HandSide::kLeft, HandSide::kRight}) {
      for (const int i : {0, 3, 6, 9}) {  // the knuckles of index, middle, little and ring finger
        const int joint = model.FindJoint(HandJointNames(side)[i]);
        full.segment<3>(3 * joint) += axis_angle.segment<3>(smpl_values - (side == HandSide::kLeft ? 6 : 3));
      }
    }
  } else {
    full.head(axis_angle.size()) += axis_angle;
  }
  BodyPose pose;
  pose.trans = trans;
  pose.rotations.reserve(J);
  for (int j = 0; j < J; ++j) pose.rotations.push_back(RotationFromAxisAngle(full.segment<3>(3 * j)));
  return pose;
}

VectorXd AxisAngleFromPose(const BodyModel& model, const BodyPose& pose) {
  VectorXd result(3 * pose.rotations.size());
  for (size_t j = 0; j < pose.rotations.size(); ++j) {
    result.segment<3>(3 * j) = AxisAngleFromRotation(pose.rotations[j]);
  }
  if (model.data().pose_mean.size() == result.size()) result -= model.data().pose_mean;
  return result;
}

PosedSkeleton PoseSkeleton(const BodyModel& model, const MatrixX3d& rest_joints, const BodyPose& pose) {
  const int J = model.num_joints();
  BODYLOOM_CHECK(static_cast<int>(pose.rotations.size()) == J, "pose has ", pose.rotations.size(),
                 " rotations, the body '", model.name(), "' has ", J, " joints");
  BODYLOOM_CHECK(rest_joints.rows() == J, "rest_joints has ", rest_joints.rows(), " rows, the body '", model.name(),
                 "' has ", J, " joints");
  PosedSkeleton skeleton;
  skeleton.rest_joints = rest_joints;
  skeleton.world_rotations.resize(J);
  skeleton.joints.resize(J, 3);
  skeleton.world_rotations[0] = pose.rotations[0];
  skeleton.joints.row(0) = rest_joints.row(0) + pose.trans.transpose();
  for (int j = 1; j < J; ++j) {
    const int p = model.parents()[j];
    skeleton.world_rotations[j].noalias() = skeleton.world_rotations[p] * pose.rotations[j];
    const Vector3d bone = (rest_joints.row(j) - rest_joints.row(p)).transpose();
    skeleton.joints.row(j) = skeleton.joints.row(p) + (skeleton.world_rotations[p] * bone).transpose();
  }
  return skeleton;
}

MatrixX3d PoseVertices(const BodyModel& model, const VectorXd& betas, const BodyPose& pose,
                       std::span<const int> vertices) {
  const PosedSkeleton skeleton = PoseSkeleton(model, model.RestJoints(betas), pose);
  const int J = model.num_joints();
  MatrixX3d offsets(J, 3);  // p_j − G_j rest_j, so that bone j maps x to G_j x + offset_j
  for (int j = 0; j < J; ++j) {
    offsets.row(j) =
        skeleton.joints.row(j) - (skeleton.world_rotations[j] * skeleton.rest_joints.row(j).transpose()).transpose();
  }
  MatrixX3d result(vertices.size(), 3);
  for (size_t i = 0; i < vertices.size(); ++i) {
    const int v = vertices[i];
    BODYLOOM_CHECK(v >= 0 && v < model.num_vertices(), "vertex ", v, " is outside 0..", model.num_vertices() - 1);
    const Vector3d rest = ShapedVertex(model, betas, v) + PoseCorrective(model, pose, v);
    Vector3d x = Vector3d::Zero();
    for (int k = model.influence_begin()[v]; k < model.influence_begin()[v + 1]; ++k) {
      const int j = model.influence_joint()[k];
      x += model.influence_weight()[k] * (skeleton.world_rotations[j] * rest + offsets.row(j).transpose());
    }
    result.row(i) = x.transpose();
  }
  return result;
}

MatrixX3d PoseVertices(const BodyModel& model, const VectorXd& betas, const BodyPose& pose) {
  std::vector<int> all(model.num_vertices());
  std::iota(all.begin(), all.end(), 0);
  return PoseVertices(model, betas, pose, all);
}

MatrixX3d PoseLandmarks(const BodyModel& model, const VectorXd& betas, const BodyPose& pose,
                        const std::vector<std::string>& names) {
  std::vector<int> vertices;
  for (const std::string& name : names) {
    const int index = model.FindLandmark(name);
    BODYLOOM_CHECK(index >= 0, "the body '", model.name(), "' has no landmark '", name, "'");
    const std::vector<int>& own = model.data().landmarks[index].vertices;
    vertices.insert(vertices.end(), own.begin(), own.end());
  }
  const MatrixX3d positions = PoseVertices(model, betas, pose, vertices);
  MatrixX3d result = MatrixX3d::Zero(names.size(), 3);
  int row = 0;
  for (size_t n = 0; n < names.size(); ++n) {
    for (double weight : model.data().landmarks[model.FindLandmark(names[n])].weights) {
      result.row(n) += weight * positions.row(row++);
    }
  }
  return result;
}

MatrixX3d ShapeVertices(const BodyModel& model, const VectorXd& betas) {
  BODYLOOM_CHECK(betas.size() <= model.num_betas(), "betas has ", betas.size(), " values, the body '", model.name(),
                 "' takes ", model.num_betas());
  MatrixX3d result(model.num_vertices(), 3);
  for (int v = 0; v < model.num_vertices(); ++v) result.row(v) = ShapedVertex(model, betas, v).transpose();
  return result;
}

// Sums in double: float would be precise enough to look at, but not to take differences of.
Vector3d ShapedVertex(const BodyModel& model, const VectorXd& betas, int vertex) {
  const BodyModelData& d = model.data();
  Vector3d result = d.v_template.row(vertex).transpose();
  for (int c = 0; c < 3; ++c) {
    const float* row = d.shapedirs.data() + (3 * static_cast<size_t>(vertex) + c) * d.shapedirs.cols();
    for (Eigen::Index b = 0; b < betas.size(); ++b) result[c] += row[b] * betas[b];
  }
  return result;
}

Vector3d PoseCorrective(const BodyModel& model, const BodyPose& pose, int vertex) {
  const PoseCorrectives& correctives = model.data().posedirs;
  Vector3d result = Vector3d::Zero();
  if (correctives.begin.empty()) return result;
  for (int k = correctives.begin[vertex]; k < correctives.begin[vertex + 1]; ++k) {
    const Eigen::Map<const Eigen::Matrix<float, 3, 9, Eigen::RowMajor>> block(&correctives.block[27 * size_t(k)]);
    const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> R = pose.rotations[correctives.joint[k]] - Matrix3d::Identity();
    result.noalias() += block.cast<double>() * Eigen::Map<const Eigen::Matrix<double, 9, 1>>(R.data());
  }
  return result;
}

}  // namespace bodyloom
