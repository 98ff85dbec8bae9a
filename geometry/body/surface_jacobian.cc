// SPDX-License-Identifier: Apache-2.0
#include "geometry/body/surface_jacobian.h"

#include "geometry/base/check.h"
#include "geometry/math/rotation.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

SurfaceJacobian::SurfaceJacobian(const BodyModel& model, const Eigen::VectorXd& betas, const BodyPose& pose)
    : model_(model), betas_(betas), pose_(pose), skeleton_(PoseSkeleton(model, model.RestJoints(betas), pose)) {
  const int J = model.num_joints();
  const auto d_rest = [&](int j) { return model.joint_shapedirs().block(3 * j, 0, 3, betas_.size()); };
  for (int j = 0; j < J; ++j) {
    const Matrix3d& G = skeleton_.world_rotations[j];
    const int p = model.parents()[j];
    offset_.push_back(skeleton_.joints.row(j).transpose() - G * skeleton_.rest_joints.row(j).transpose());
    if (p < 0) {
      d_joint_d_betas_.push_back(d_rest(j));
    } else {
      d_joint_d_betas_.push_back(d_joint_d_betas_[p] + skeleton_.world_rotations[p] * (d_rest(j) - d_rest(p)));
    }
    d_offset_d_betas_.push_back(d_joint_d_betas_[j] - G * d_rest(j));
  }
}

PointJacobian SurfaceJacobian::At(const SurfacePoint& point) const {
  BODYLOOM_CHECK(point.face >= 0 && point.face < model_.num_faces(), "face ", point.face, " is outside 0..",
                 model_.num_faces() - 1);
  const Eigen::RowVector3i corners = model_.data().faces.row(point.face);
  return OfVertices(std::span<const int>(corners.data(), 3), std::span<const double>(point.barycentric.data(), 3));
}

PointJacobian SurfaceJacobian::OfVertices(std::span<const int> vertices, std::span<const double> weights) const {
  BODYLOOM_CHECK(vertices.size() == weights.size(), vertices.size(), " vertices and ", weights.size(), " weights");
  const int J = model_.num_joints();
  const BodyModelData& d = model_.data();
  PointJacobian result;
  result.d_point_d_betas.setZero(3, betas_.size());
  // Over all vertices: bone_sum = Σ a w_i x_i and bone_weight = Σ a w_i, first by bone, then by subtree.
  std::vector<Vector3d> bone_sum(J, Vector3d::Zero());
  std::vector<double> bone_weight(J, 0.0);
  std::vector<Matrix3d> by_rotation(J, Matrix3d::Zero());
  std::vector<bool> moves(J, false), corrects(J, false);
  for (size_t n = 0; n < vertices.size(); ++n) {
    const int v = vertices[n];
    const double a = weights[n];
    BODYLOOM_CHECK(v >= 0 && v < model_.num_vertices(), "vertex ", v, " is outside 0..", model_.num_vertices() - 1);
    if (a == 0) continue;
    const Vector3d rest = ShapedVertex(model_, betas_, v) + PoseCorrective(model_, pose_, v);
    Matrix3d M = Matrix3d::Zero();
    for (int k = model_.influence_begin()[v]; k < model_.influence_begin()[v + 1]; ++k) {
      const int i = model_.influence_joint()[k];
      const double w = model_.influence_weight()[k];
      const Matrix3d& G = skeleton_.world_rotations[i];
      M += w * G;
      bone_sum[i] += a * w * (G * rest + offset_[i]);
      bone_weight[i] += a * w;
      moves[i] = true;
      result.d_point_d_betas += a * w * d_offset_d_betas_[i];
    }
    if (betas_.size() > 0) {
      result.d_point_d_betas += a * M * d.shapedirs.block(3 * v, 0, 3, betas_.size()).cast<double>();
    }
    if (d.posedirs.begin.empty()) continue;
    for (int k = d.posedirs.begin[v]; k < d.posedirs.begin[v + 1]; ++k) {
      const int j = d.posedirs.joint[k];
      const Eigen::Map<const Eigen::Matrix<float, 3, 9, Eigen::RowMajor>> block(&d.posedirs.block[27 * size_t(k)]);
      by_rotation[j] += a * M * (block.cast<double>() * EntriesByIncrement(pose_.rotations[j]));
      corrects[j] = true;
    }
  }
  for (int j = J - 1; j > 0; --j) {
    if (!moves[j]) continue;
    const int p = model_.parents()[j];
    bone_sum[p] += bone_sum[j];
    bone_weight[p] += bone_weight[j];
    moves[p] = true;
  }
  for (int j = 0; j < J; ++j) {
    if (!moves[j] && !corrects[j]) continue;
    if (moves[j]) {
      const Vector3d lever = bone_sum[j] - bone_weight[j] * skeleton_.joints.row(j).transpose();
      by_rotation[j] -= Skew(lever) * skeleton_.world_rotations[j];
    }
    result.joints.push_back(j);
    result.d_point_d_rotation.push_back(by_rotation[j]);
  }
  result.point = bone_sum[0];  // every bone is below the root
  result.d_point_d_trans = bone_weight[0];
  return result;
}

PointJacobian SurfaceJacobian::OfJoint(int joint) const {
  BODYLOOM_CHECK(joint >= 0 && joint < model_.num_joints(), "joint ", joint, " is outside 0..",
                 model_.num_joints() - 1);
  PointJacobian result;
  result.point = skeleton_.joints.row(joint).transpose();
  for (int j : model_.ancestors(joint)) {
    if (j == joint) continue;  // a joint turns about itself
    result.joints.push_back(j);
    result.d_point_d_rotation.push_back(-Skew(result.point - skeleton_.joints.row(j).transpose()) *
                                        skeleton_.world_rotations[j]);
  }
  result.d_point_d_betas = d_joint_d_betas_[joint];
  result.d_point_d_trans = 1;
  return result;
}

}  // namespace bodyloom
