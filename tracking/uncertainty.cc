// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/uncertainty.h"

#include <cmath>
#include <limits>

#include "bodyloom/geometry/rotation.h"
#include "bodyloom/tracking/chain/chain_covariance.h"
#include "bodyloom/tracking/kinematics.h"

namespace bodyloom {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

VectorXd JointSigmaOf(const FrameLayout& layout, const FrameState& state, const VectorXd& betas, const MatrixXd& P) {
  const BodyModel& model = *layout.model;
  const int J = model.num_joints(), n = layout.num_frame_columns();
  const bool shape_known = layout.num_betas == 0 || P.cols() < n + layout.num_betas;
  Kinematics kinematics;
  kinematics.Set(model, betas, state.rotations, layout.BodyTranslation(state), !shape_known);
  RowMatrixXd D = RowMatrixXd::Zero(3 * J, P.cols());
  for (int j = 0; j < J; ++j) {
    for (int a : model.ancestors(j)) {
      const int column = layout.column_of_joint[a];
      if (column < 0 || a == j) continue;
      D.block<3, 3>(3 * j, column) = -Skew(kinematics.p[j] - kinematics.p[a]) * kinematics.G[a];
    }
    if (layout.knowledge == CameraKnowledge::kWeak) {
      D(3 * j, layout.translation_column + 1) = D(3 * j + 1, layout.translation_column + 2) = 1;
    } else {
      D.block<3, 3>(3 * j, layout.translation_column).setIdentity();
    }
    if (!shape_known) D.block(3 * j, n, 3, layout.num_betas) = kinematics.dp[j];
  }
  const VectorXd variance = (D * P).cwiseProduct(D).rowwise().sum();
  VectorXd sigma(J);
  for (int j = 0; j < J; ++j) sigma[j] = std::sqrt(variance.segment<3>(3 * j).sum() / 3);
  return sigma;
}

RowMatrixXd JointPositionSigma(const SequenceProblem& problem, int num_threads, double* focal_log_sigma) {
  const auto T = static_cast<int>(problem.states.size());
  RowMatrixXd sigma =
      RowMatrixXd::Constant(T, problem.layout.model->num_joints(), std::numeric_limits<double>::quiet_NaN());
  ChainProblem chain(problem, false, false, num_threads);
  if (!std::isfinite(chain.Linearise({problem.states, problem.betas, problem.log_focal}))) return sigma;
  ChainFactor factor(chain.frame_size(), chain.shared_size(), chain.cut_before());
  VisitCovariance(&chain, &factor, 0, T, num_threads, [&](int t, const MatrixXd& P) {
    sigma.row(t) = JointSigmaOf(problem.layout, problem.states[t], problem.betas, P).transpose();
    // The last of the shared values, the same in every frame's covariance.
    if (t == 0 && focal_log_sigma != nullptr && problem.layout.focal_column >= 0) {
      *focal_log_sigma = std::sqrt(P(P.rows() - 1, P.cols() - 1));
    }
  });
  return sigma;
}

}  // namespace bodyloom
