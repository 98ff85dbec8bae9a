// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/kinematics.h"

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/rotation.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;

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
