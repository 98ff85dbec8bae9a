// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "tracking/solvers/chain/chain_factor.h"
#include "tracking/solvers/chain/chain_problem.h"

namespace bodyloom {

// Covariance of a linearised chain's unknowns.

/// visit(t, P) for the frames begin ≤ t < end, from up to num_threads threads (ChainFactor::VisitInverse): P is the
/// (n + s)² covariance H⁻¹ of frame t's columns and of the shared values that are unknown, all other frames being
/// unknown too. H is the Gauss–Newton matrix at the point that `chain` was linearised at, undamped, with 1e-6 on the
/// frames' diagonal: what nothing holds keeps a spread of a thousand radians or metres. False, with nothing visited,
/// when it is not positive definite.
bool VisitCovariance(ChainProblem* chain, ChainFactor* factor, int begin, int end, int num_threads,
                     const std::function<void(int, const Eigen::MatrixXd&)>& visit);

}  // namespace bodyloom
