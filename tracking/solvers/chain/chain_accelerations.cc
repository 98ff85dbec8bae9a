// SPDX-License-Identifier: Apache-2.0
// Costs of the accelerations and velocities of ChainProblem's frames, and their blocks of its matrix: an acceleration
// couples three frames, a velocity two.
#include <algorithm>

#include "geometry/base/parallel.h"
#include "geometry/math/rotation.h"
#include "tracking/solvers/chain/chain_problem.h"
#include "tracking/solvers/residuals/acceleration_cost.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using RowMatrix3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

bool ChainProblem::HasAcceleration(size_t t) const {
  return t >= 2 && t < systems_.size() && !problem_.cut_before[t] && !problem_.cut_before[t - 1];
}

bool ChainProblem::HasVelocity(size_t t) const {
  return problem_.velocity_weight > 0 && t >= 1 && t < systems_.size() && !problem_.cut_before[t];
}

double ChainProblem::EvaluateChanges(const ChainPoint& point, bool derivatives) {
  const int T = static_cast<int>(point.states.size());
  const std::vector<int>& joints = problem_.layout.active_joints;
  ParallelFor(T, num_threads_, [&](int t) {
    // The change that ends at t has a part in the accelerations that end at t and at t + 1, and is t's velocity.
    if (t == 0 || !(HasAcceleration(t) || HasAcceleration(t + 1) || HasVelocity(t)) || AllFrozen(t - 1, t)) return;
    Change& change = changes_[t];
    change.step.resize(blocks_);
    if (derivatives) change.right.resize(joints.size());
    for (size_t a = 0; a < joints.size(); ++a) {
      change.step[a] = AxisAngleFromRotation(point.states[t - 1].rotations[joints[a]].transpose() *
                                             point.states[t].rotations[joints[a]]);
      if (derivatives) change.right[a] = RightJacobianInverse(change.step[a]);
    }
    change.step[joints.size()] = point.states[t].translation - point.states[t - 1].translation;
  });
  double sum = 0;
  for (int t = 2; t < T; ++t) {
    if (!HasAcceleration(t)) continue;
    double& cost = acceleration_costs_[t];
    if (AllFrozen(t - 2, t)) {
      sum += cost;
      continue;
    }
    const AccelerationFactors& f = factors_[t];
    const std::vector<Eigen::Array3d>& inverse_sigma = InverseSigma(t);
    cost = 0;
    for (int a = 0; a < blocks_; ++a) {
      cost += 0.5 * (inverse_sigma[a] * (f.later * changes_[t].step[a] - f.earlier * changes_[t - 1].step[a]).array())
                        .square()
                        .sum();
    }
    sum += cost;
  }
  for (int t = 1; t < T; ++t) {
    if (!HasVelocity(t)) continue;
    double& cost = velocity_costs_[t];
    if (!AllFrozen(t - 1, t)) {
      const double rate = 1 / (problem_.timestamps[t] - problem_.timestamps[t - 1]);
      cost = 0;
      for (int a = 0; a < blocks_; ++a) {
        cost += 0.5 * (inverse_velocity_sigma_[a] * rate * changes_[t].step[a].array()).square().sum();
      }
    }
    sum += cost;
  }
  return sum;
}

void ChainProblem::AccelerationOf(size_t end, int a, Matrix3d J[3], Eigen::Array3d* weight, Vector3d* force) const {
  const AccelerationFactors& f = factors_[end];
  const Change &first = changes_[end - 1], &last = changes_[end];
  if (a + 1 < blocks_) {
    RotationAccelerationJacobians(f, first.right[a], last.right[a], J);
  } else {
    J[0] = f.earlier * Matrix3d::Identity();
    J[1] = -(f.earlier + f.later) * Matrix3d::Identity();
    J[2] = f.later * Matrix3d::Identity();
  }
  *weight = InverseSigma(end)[a].square();
  *force = (*weight * (f.later * last.step[a] - f.earlier * first.step[a]).array()).matrix();
}

void ChainProblem::AssembleAcceleration(size_t t) {
  double* own = &own_[t * 3 * n_];
  double* next = &next_[t * 3 * n_];
  double* second = &second_[t * 3 * n_];
  std::fill(own, own + 3 * n_, 0.0);
  std::fill(next, next + 3 * n_, 0.0);
  std::fill(second, second + 3 * n_, 0.0);
  for (size_t end = t; end <= t + 2; ++end) {  // frame t is the last, the middle or the first of these three
    if (!HasAcceleration(end)) continue;
    const size_t role = t + 2 - end;  // 2, 1, 0: its place in (end − 2, end − 1, end)
    for (int a = 0; a < blocks_; ++a) {
      Matrix3d J[3];
      Eigen::Array3d weight;
      Vector3d force;
      AccelerationOf(end, a, J, &weight, &force);
      const Matrix3d weighted = J[role].transpose() * weight.matrix().asDiagonal();
      gradient_.segment<3>(static_cast<Eigen::Index>(t * n_ + 3 * a)) += J[role].transpose() * force;
      Eigen::Map<RowMatrix3d>(own + 9 * a) += weighted * J[role];
      if (role < 2) Eigen::Map<RowMatrix3d>(next + 9 * a) += weighted * J[role + 1];
      if (role == 0) Eigen::Map<RowMatrix3d>(second + 9 * a) += weighted * J[2];
    }
  }
}

void ChainProblem::AssembleVelocity(size_t t) {
  double* own = &own_[t * 3 * n_];
  double* next = &next_[t * 3 * n_];
  for (size_t end = t; end <= t + 1; ++end) {  // frame t is the last or the first of these two
    if (!HasVelocity(end)) continue;
    const size_t role = t + 1 - end;
    const double rate = 1 / (problem_.timestamps[end] - problem_.timestamps[end - 1]);
    const Change& change = changes_[end];
    for (int a = 0; a < blocks_; ++a) {
      Matrix3d J[2] = {-Matrix3d::Identity(), Matrix3d::Identity()};
      if (a + 1 < blocks_) RotationStepJacobians(change.right[a], J);
      const Vector3d weight = (rate * inverse_velocity_sigma_[a]).square().matrix();
      const Matrix3d weighted = J[role].transpose() * weight.asDiagonal();
      gradient_.segment<3>(static_cast<Eigen::Index>(t * n_ + 3 * a)) += weighted * change.step[a];
      Eigen::Map<RowMatrix3d>(own + 9 * a) += weighted * J[role];
      if (role == 0) Eigen::Map<RowMatrix3d>(next + 9 * a) += weighted * J[1];
    }
  }
}

}  // namespace bodyloom
