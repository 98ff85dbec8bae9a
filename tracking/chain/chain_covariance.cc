// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/chain/chain_covariance.h"

namespace bodyloom {

bool VisitCovariance(ChainProblem* chain, ChainFactor* factor, int begin, int end, int num_threads,
                     const std::function<void(int, const Eigen::MatrixXd&)>& visit) {
  constexpr double kNothing = 1e-6;
  const Eigen::VectorXd hold = Eigen::VectorXd::Constant(chain->gradient().size(), kNothing);
  chain->SetDamping(&hold);
  Eigen::VectorXd step, shared_step;
  const Eigen::MatrixXd arrow = chain->Arrow(Eigen::VectorXd::Zero(chain->shared_size()));
  const bool solved =
      factor->Solve(*chain, arrow, Eigen::VectorXd::Zero(chain->arrow_size()), num_threads, &step, &shared_step);
  chain->SetDamping(nullptr);
  const int size = chain->frame_size() + chain->shared_size();
  if (!solved) return false;
  if (chain->num_far_rows() == 0) {
    factor->VisitInverse(begin, end, num_threads, visit);
  } else {  // without multipliers
    factor->VisitInverse(begin, end, num_threads,
                         [&](int t, const Eigen::MatrixXd& P) { visit(t, P.topLeftCorner(size, size)); });
  }
  return solved;
}

}  // namespace bodyloom
