// SPDX-License-Identifier: Apache-2.0
/// Covariance of a linearised chain's unknowns.
#pragma once

#include <functional>

#include "tracking/solvers/chain/chain_factor.h"
#include "tracking/solvers/chain/chain_problem.h"

namespace bodyloom {

/// Calls visit(t, P) for the frames begin ≤ t < end, from up to num_threads threads (ChainFactor::VisitInverse): P is
/// the (n + s)² covariance H⁻¹ of frame t's columns and of the shared values that are unknown, marginalised over all
/// other frames. H is the Gauss–Newton matrix at the point at which `chain` was linearised, undamped, with 1e-6 added
/// to the frames' diagonal, so that unconstrained unknowns have a σ of a thousand radians or metres. Returns false,
/// without a visit, when H is not positive definite. `shared_covariance`: that of the shared values by all that tells
/// of them, of a chain that is part of a clip; null: H tells it. Not with couplings of frames that are no neighbours.
bool VisitCovariance(ChainProblem* chain, ChainFactor* factor, int begin, int end, int num_threads,
                     const std::function<void(int, const Eigen::MatrixXd&)>& visit,
                     const Eigen::MatrixXd* shared_covariance = nullptr);

}  // namespace bodyloom
