// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/chain/chain_covariance.h"

namespace bodyloom {

bool VisitCovariance(ChainProblem* chain, ChainFactor* factor, int begin, int end, int num_threads,
                     const std::function<void(int, const Eigen::MatrixXd&)>& visit) {
  constexpr double kNothing = 1e-6;
  const Eigen::VectorXd hold = Eigen::VectorXd::Constant(chain->gradient().size(), kNothing);
  chain->SetDamping(&hold);
  Eigen::VectorXd step, shared_step;
  const bool solved =
      factor->Solve(*chain, chain->shared(), -chain->shared_gradient(), num_threads, &step, &shared_step);
  chain->SetDamping(nullptr);
  if (solved) factor->VisitInverse(begin, end, num_threads, visit);
  return solved;
}

}  // namespace bodyloom
