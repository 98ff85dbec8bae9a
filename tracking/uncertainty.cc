// SPDX-License-Identifier: Apache-2.0
#include "tracking/uncertainty.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "geometry/check.h"
#include "geometry/rotation.h"
#include "tracking/kinematics.h"
#include "tracking/residuals/acceleration_cost.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using RowMatrix3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

std::vector<MatrixXd> BlockTridiagonalInverseDiagonal(const std::vector<MatrixXd>& diagonal,
                                                      const std::vector<MatrixXd>& upper) {
  const size_t n = diagonal.size();
  BODYLOOM_CHECK(n > 0 && upper.size() + 1 == n, "block tridiagonal inverse: ", n, " diagonal and ", upper.size(),
                 " off-diagonal blocks");
  std::vector<Eigen::LLT<MatrixXd>> factors(n);
  std::vector<MatrixXd> gains(n);  // K_i = S_i⁻¹ C_i
  MatrixXd S = diagonal[0];
  for (size_t i = 0; i < n; ++i) {
    factors[i].compute(S);
    if (factors[i].info() != Eigen::Success) return {};
    if (i + 1 == n) break;
    gains[i] = factors[i].solve(upper[i]);
    S = diagonal[i + 1];
    S.noalias() -= upper[i].transpose() * gains[i];
  }
  std::vector<MatrixXd> inverse(n);
  for (size_t i = n; i-- > 0;) {
    inverse[i] = factors[i].solve(MatrixXd::Identity(diagonal[i].rows(), diagonal[i].cols()));
    if (i + 1 < n) inverse[i].noalias() += gains[i] * inverse[i + 1] * gains[i].transpose();
  }
  return inverse;
}

namespace {

/// The clip's normal matrix in frame blocks: band[k][t] = block (t, t + k), k = 0, 1, 2.
struct Band {
  std::vector<MatrixXd> diagonal, first, second;
};

void AddAcceleration(const ceres::CostFunction& cost, const double* const values[3], int column, size_t t, Band* band) {
  double residuals[3];
  RowMatrix3d J[3];
  double* jacobians[3] = {J[0].data(), J[1].data(), J[2].data()};
  cost.Evaluate(values, residuals, jacobians);
  for (size_t k = 0; k < 3; ++k) band->diagonal[t - 2 + k].block<3, 3>(column, column) += J[k].transpose() * J[k];
  band->first[t - 2].block<3, 3>(column, column) += J[0].transpose() * J[1];
  band->first[t - 1].block<3, 3>(column, column) += J[1].transpose() * J[2];
  band->second[t - 2].block<3, 3>(column, column) += J[0].transpose() * J[2];
}

Band AssembleBand(const SequenceProblem& problem) {
  const size_t T = problem.states.size();
  const FrameLayout& layout = problem.layout;
  const int n = layout.num_frame_columns();
  Band band;
  FrameEvaluator evaluator;
  FrameSystem system;
  for (size_t t = 0; t < T; ++t) {
    evaluator.Evaluate(layout, problem.frames[t], problem.states[t], problem.betas, problem.log_focal, true, &system);
    MatrixXd H = MatrixXd(system.H.selfadjointView<Eigen::Lower>()).topLeftCorner(n, n);
    H.diagonal().array() += 1e-6;  // a frame without any information stays invertible, with a spread of a kilometre
    band.diagonal.push_back(std::move(H));
    band.first.push_back(MatrixXd::Zero(n, n));
    band.second.push_back(MatrixXd::Zero(n, n));
  }
  const std::vector<int> shot = ShotOfFrames(problem.cut_before);
  std::vector<double> joint_sigma;
  for (size_t t = 2; t < T; ++t) {
    if (joint_sigma.empty() || shot[t] != shot[t - 1]) joint_sigma = JointAccelerationSigma(problem, shot[t]);
    if (problem.cut_before[t] || problem.cut_before[t - 1]) continue;
    const double dt0 = problem.timestamps[t - 1] - problem.timestamps[t - 2];
    const double dt1 = problem.timestamps[t] - problem.timestamps[t - 1];
    for (size_t a = 0; a < layout.active_joints.size(); ++a) {
      const int joint = layout.active_joints[a];
      Vector3d w[3];
      const double* values[3];
      for (int k = 0; k < 3; ++k) {
        w[k] = AxisAngleFromRotation(problem.states[t - 2 + k].rotations[joint]);
        values[k] = w[k].data();
      }
      AddAcceleration(RotationAccelerationCost(dt0, dt1, joint_sigma[joint]), values, static_cast<int>(3 * a), t,
                      &band);
    }
    const double* values[3];
    for (int k = 0; k < 3; ++k) values[k] = problem.states[t - 2 + k].translation.data();
    const std::array<double, 3> sigma = RootAccelerationSigma(problem, shot[t]);
    AddAcceleration(VectorAccelerationCost(dt0, dt1, sigma.data()), values, layout.translation_column, t, &band);
  }
  return band;
}

}  // namespace

RowMatrixXd JointPositionSigma(const SequenceProblem& problem) {
  const size_t T = problem.states.size();
  const FrameLayout& layout = problem.layout;
  const BodyModel& model = *layout.model;
  const int n = layout.num_frame_columns(), J = model.num_joints();
  RowMatrixXd sigma = RowMatrixXd::Constant(T, J, std::numeric_limits<double>::quiet_NaN());
  const Band band = AssembleBand(problem);
  // Two frames make one block, which turns the pentadiagonal band into a tridiagonal one.
  std::vector<MatrixXd> diagonal, upper;
  for (size_t t = 0; t < T; t += 2) {
    const bool pair = t + 1 < T;
    MatrixXd D(pair ? 2 * n : n, pair ? 2 * n : n);
    D.topLeftCorner(n, n) = band.diagonal[t];
    if (pair) {
      D.topRightCorner(n, n) = band.first[t];
      D.bottomLeftCorner(n, n) = band.first[t].transpose();
      D.bottomRightCorner(n, n) = band.diagonal[t + 1];
    }
    if (t + 2 < T) {
      const bool next_pair = t + 3 < T;
      MatrixXd C = MatrixXd::Zero(2 * n, next_pair ? 2 * n : n);
      C.topLeftCorner(n, n) = band.second[t];
      C.bottomLeftCorner(n, n) = band.first[t + 1];
      if (next_pair) C.bottomRightCorner(n, n) = band.second[t + 1];
      upper.push_back(std::move(C));
    }
    diagonal.push_back(std::move(D));
  }
  const std::vector<MatrixXd> inverse = BlockTridiagonalInverseDiagonal(diagonal, upper);
  if (inverse.empty()) return sigma;

  Kinematics kinematics;
  MatrixXd d_joint(3, n);
  for (size_t t = 0; t < T; ++t) {
    const auto covariance = inverse[t / 2].block((t % 2) * n, (t % 2) * n, n, n);
    const FrameState& state = problem.states[t];
    const bool weak = layout.knowledge == CameraKnowledge::kWeak;
    kinematics.Set(model, problem.betas, state.rotations, weak ? Vector3d(Vector3d::Zero()) : state.translation, false);
    for (int j = 0; j < J; ++j) {
      d_joint.setZero();
      for (int a : model.ancestors(j)) {
        const int column = layout.column_of_joint[a];
        if (column < 0 || a == j) continue;
        d_joint.middleCols<3>(column) = -Skew(kinematics.p[j] - kinematics.p[a]) * kinematics.G[a];
      }
      if (weak) {
        d_joint(0, layout.translation_column + 1) = d_joint(1, layout.translation_column + 2) = 1;
      } else {
        d_joint.middleCols<3>(layout.translation_column) = Matrix3d::Identity();
      }
      sigma(t, j) = std::sqrt((d_joint * covariance * d_joint.transpose()).trace() / 3);
    }
  }
  return sigma;
}

}  // namespace bodyloom
