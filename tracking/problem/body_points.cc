// SPDX-License-Identifier: Apache-2.0
#include "tracking/problem/body_points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/math/rotation.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix39d = Eigen::Matrix<double, 3, 9>;

CompiledPoint CompilePoint(const BodyModel& model, std::span<const int> vertices, std::span<const double> weights,
                           int num_betas) {
  BODYLOOM_CHECK(vertices.size() == weights.size() && !vertices.empty(),
                 "a body point needs as many weights as vertices, got ", weights.size(), " and ", vertices.size());
  const BodyModelData& d = model.data();
  CompiledPoint point;
  std::map<int, int> bone_of_joint;
  std::map<std::pair<int, int>, int> corrective_of;
  for (size_t n = 0; n < vertices.size(); ++n) {
    const int v = vertices[n];
    for (int k = model.influence_begin()[v]; k < model.influence_begin()[v + 1]; ++k) {
      const int joint = model.influence_joint()[k];
      const double w = weights[n] * model.influence_weight()[k];
      const auto [it, is_new] = bone_of_joint.try_emplace(joint, static_cast<int>(point.bones.size()));
      if (is_new) {
        CompiledPoint::Bone bone;
        bone.joint = joint;
        bone.q0.setZero();
        bone.Q.setZero(3, num_betas);
        point.bones.push_back(std::move(bone));
      }
      CompiledPoint::Bone& bone = point.bones[it->second];
      bone.weight += w;
      bone.q0 += w * d.v_template.row(v).transpose();
      bone.Q += w * d.shapedirs.block(3 * v, 0, 3, num_betas).cast<double>();
      if (d.posedirs.begin.empty()) continue;
      for (int c = d.posedirs.begin[v]; c < d.posedirs.begin[v + 1]; ++c) {
        const std::pair<int, int> key(it->second, d.posedirs.joint[c]);
        const auto [jt, fresh] = corrective_of.try_emplace(key, static_cast<int>(point.correctives.size()));
        if (fresh) point.correctives.push_back({key.first, key.second, Matrix39d::Zero()});
        const Eigen::Map<const Eigen::Matrix<float, 3, 9, Eigen::RowMajor>> block(&d.posedirs.block[27 * c]);
        point.correctives[jt->second].P += w * block.cast<double>();
      }
    }
  }
  return point;
}

void PointEvaluator::VertexCache::NewFrame(const Kinematics& kinematics) {
  const size_t V = kinematics.model->num_vertices();
  if (stamp_.size() != V) {
    stamp_.assign(V, 0);
    rest_.resize(V);
    frame_ = 0;
  }
  ++frame_;
}

const Vector3d& PointEvaluator::VertexCache::Rest(const Kinematics& kinematics, int v) {
  if (stamp_[v] == frame_) return rest_[v];
  stamp_[v] = frame_;
  const BodyModelData& d = kinematics.model->data();
  Vector3d x = d.v_template.row(v).transpose();
  const int B = static_cast<int>(kinematics.betas.size());
  for (int c = 0; c < 3; ++c) {
    const float* row = d.shapedirs.data() + (3 * static_cast<size_t>(v) + c) * d.shapedirs.cols();
    for (int b = 0; b < B; ++b) x[c] += row[b] * kinematics.betas[b];
  }
  if (!d.posedirs.begin.empty()) {
    for (int k = d.posedirs.begin[v]; k < d.posedirs.begin[v + 1]; ++k) {
      const float* block = &d.posedirs.block[27 * static_cast<size_t>(k)];
      const auto& f = kinematics.feature[d.posedirs.joint[k]];
      for (int c = 0; c < 3; ++c) {
        double sum = 0;
        for (int m = 0; m < 9; ++m) sum += block[9 * c + m] * f[m];
        x[c] += sum;
      }
    }
  }
  rest_[v] = x;
  return rest_[v];
}

Vector3d PointEvaluator::VertexPosition(const Kinematics& kin, int v, VertexCache* cache) {
  const BodyModel& model = *kin.model;
  const Vector3d& rest = cache->Rest(kin, v);
  Vector3d x = Vector3d::Zero();
  for (int i = model.influence_begin()[v]; i < model.influence_begin()[v + 1]; ++i) {
    const int joint = model.influence_joint()[i];
    x += model.influence_weight()[i] * (kin.G[joint] * rest + kin.t[joint]);
  }
  return x;
}

void PointEvaluator::Begin(const Kinematics& kinematics) {
  const size_t J = kinematics.G.size();
  if (sum_.size() != J) {
    sum_.assign(J, Vector3d::Zero());
    weight_.assign(J, 0);
    corrective_.assign(J, Matrix39d::Zero());
    has_corrective_.assign(J, 0);
    is_touched_.assign(J, 0);
    touched_.clear();
    corrective_joints_.clear();
  }
  for (int j : touched_) {
    sum_[j].setZero();
    weight_[j] = 0;
    is_touched_[j] = 0;
  }
  for (int j : corrective_joints_) {
    corrective_[j].setZero();
    has_corrective_[j] = 0;
  }
  touched_.clear();
  corrective_joints_.clear();
}

void PointEvaluator::AddBone(const Kinematics& kinematics, int joint, double weight, const Vector3d& y, bool jacobian) {
  if (!jacobian) return;
  for (int j = joint; j >= 0; j = kinematics.model->parents()[j]) {
    if (!is_touched_[j]) {
      is_touched_[j] = 1;
      touched_.push_back(j);
    }
    sum_[j] += y;
    weight_[j] += weight;
  }
}

Vector3d PointEvaluator::Evaluate(const Kinematics& kin, const CompiledPoint& point, bool jacobian) {
  Begin(kin);
  Vector3d x = Vector3d::Zero();
  const int B = static_cast<int>(kin.betas.size());
  if (jacobian) shape_.setZero(3, B);
  thread_local std::vector<Vector3d> q;
  q.resize(point.bones.size());
  for (size_t i = 0; i < point.bones.size(); ++i) {
    q[i] = point.bones[i].q0;
    if (B > 0) q[i].noalias() += point.bones[i].Q.leftCols(B) * kin.betas;
  }
  for (const CompiledPoint::Corrective& c : point.correctives) q[c.bone].noalias() += c.P * kin.feature[c.joint];
  for (size_t i = 0; i < point.bones.size(); ++i) {
    const CompiledPoint::Bone& bone = point.bones[i];
    const Vector3d y = kin.G[bone.joint] * q[i] + bone.weight * kin.t[bone.joint];
    x += y;
    AddBone(kin, bone.joint, bone.weight, y, jacobian);
    if (jacobian && B > 0) {
      shape_.noalias() += kin.G[bone.joint] * bone.Q.leftCols(B);
      shape_ += bone.weight * kin.dt[bone.joint];
    }
  }
  if (jacobian) {
    for (const CompiledPoint::Corrective& c : point.correctives) {
      if (!has_corrective_[c.joint]) {
        has_corrective_[c.joint] = 1;
        corrective_joints_.push_back(c.joint);
        if (!is_touched_[c.joint]) {
          is_touched_[c.joint] = 1;
          touched_.push_back(c.joint);
        }
      }
      corrective_[c.joint].noalias() += kin.G[point.bones[c.bone].joint] * c.P;
    }
  }
  return x;
}

Vector3d PointEvaluator::Evaluate(const Kinematics& kin, const int vertices[3], const double barycentric[3],
                                  VertexCache* cache, bool jacobian) {
  Begin(kin);
  const BodyModel& model = *kin.model;
  const BodyModelData& d = model.data();
  const int B = static_cast<int>(kin.betas.size());
  if (jacobian) shape_.setZero(3, B);
  Vector3d x = Vector3d::Zero();
  // Detectors' floats sum to 1 within rounding only; the point's weights have to do so exactly for d x / d trans = I.
  const double sum = barycentric[0] + barycentric[1] + barycentric[2];
  for (int k = 0; k < 3; ++k) {
    const double b = barycentric[k] / sum;
    if (b == 0) continue;
    const int v = vertices[k];
    const Vector3d& rest = cache->Rest(kin, v);
    Matrix3d M = Matrix3d::Zero();
    for (int i = model.influence_begin()[v]; i < model.influence_begin()[v + 1]; ++i) {
      const int joint = model.influence_joint()[i];
      const double w = b * model.influence_weight()[i];
      const Vector3d y = w * (kin.G[joint] * rest + kin.t[joint]);
      x += y;
      if (!jacobian) continue;
      AddBone(kin, joint, w, y, true);
      M += w * kin.G[joint];
      if (B > 0) shape_ += w * kin.dt[joint];
    }
    if (!jacobian) continue;
    if (B > 0) shape_.noalias() += M * d.shapedirs.block(3 * v, 0, 3, B).cast<double>();
    if (d.posedirs.begin.empty()) continue;
    for (int c = d.posedirs.begin[v]; c < d.posedirs.begin[v + 1]; ++c) {
      const int joint = d.posedirs.joint[c];
      if (!has_corrective_[joint]) {
        has_corrective_[joint] = 1;
        corrective_joints_.push_back(joint);
        if (!is_touched_[joint]) {
          is_touched_[joint] = 1;
          touched_.push_back(joint);
        }
      }
      const Eigen::Map<const Eigen::Matrix<float, 3, 9, Eigen::RowMajor>> block(
          &d.posedirs.block[27 * static_cast<size_t>(c)]);
      corrective_[joint].noalias() += M * block.cast<double>();
    }
  }
  return x;
}

Matrix3d PointEvaluator::JointJacobian(const Kinematics& kin, int j) const {
  const Vector3d lever = sum_[j] - weight_[j] * kin.p[j];
  // −[lever]× G, column by column: −lever × g = g × lever.
  Matrix3d result;
  for (int m = 0; m < 3; ++m) result.col(m) = kin.G[j].col(m).cross(lever);
  if (has_corrective_[j]) result.noalias() += corrective_[j] * kin.feature_jacobian[j];
  return result;
}

void Kinematics::Set(const BodyModel& body, const Eigen::VectorXd& shape, const std::vector<Matrix3d>& rotations,
                     const Vector3d& trans, bool derivatives) {
  const int J = body.num_joints();
  const int B = static_cast<int>(shape.size());
  BODYLOOM_CHECK(static_cast<int>(rotations.size()) == J, "kinematics: ", rotations.size(), " rotations for ", J,
                 " joints");
  BODYLOOM_CHECK(B <= body.num_betas() && B <= kMaxBetas, "kinematics: ", B, " betas, the body has ", body.num_betas(),
                 " and at most ", kMaxBetas, " are estimated");
  const bool new_shape = model != &body || betas.size() != B || betas != shape || static_cast<int>(rest.size()) != J;
  model = &body;
  if (new_shape) {
    betas = shape;
    rest.resize(J);
    for (int j = 0; j < J; ++j) {
      rest[j] = body.joint_template().row(j).transpose();
      if (B > 0) rest[j] += body.joint_shapedirs().block(3 * j, 0, 3, B) * betas;
    }
  }
  R = rotations;
  G.resize(J);
  p.resize(J);
  t.resize(J);
  feature.resize(J);
  for (int j = 0; j < J; ++j) {
    if (j == 0) {
      G[0] = R[0];
      p[0] = rest[0] + trans;
    } else {
      const int parent = body.parents()[j];
      G[j].noalias() = G[parent] * R[j];
      p[j] = p[parent] + G[parent] * (rest[j] - rest[parent]);
    }
    t[j] = p[j] - G[j] * rest[j];
    for (int k = 0; k < 9; ++k) feature[j][k] = R[j](k / 3, k % 3) - (k % 4 == 0 ? 1.0 : 0.0);
  }
  if (!derivatives) return;
  dp.resize(J);
  dt.resize(J);
  feature_jacobian.resize(J);
  for (int j = 0; j < J; ++j) {
    const auto d_rest = body.joint_shapedirs().block(3 * j, 0, 3, B);
    if (j == 0) {
      dp[0] = d_rest;
    } else {
      const int parent = body.parents()[j];
      dp[j] = dp[parent];
      dp[j].noalias() += G[parent] * (d_rest - body.joint_shapedirs().block(3 * parent, 0, 3, B));
    }
    dt[j] = dp[j];
    dt[j].noalias() -= G[j] * d_rest;
    for (int m = 0; m < 3; ++m) {
      const Matrix3d dR = R[j] * Skew(Vector3d::Unit(m));
      for (int k = 0; k < 9; ++k) feature_jacobian[j](k, m) = dR(k / 3, k % 3);
    }
  }
}

}  // namespace bodyloom
