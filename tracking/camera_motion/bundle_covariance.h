// SPDX-License-Identifier: Apache-2.0
/// Covariances of a bundle adjustment at its solution, from the scatter of its points.
///
/// The error with which a point is followed lasts: a corner sought in an anchor's picture is off by much the same in
/// neighbouring frames, and where it lives on it takes its error along. So a point with all that is seen of it counts
/// as one observation, not each of its pixels:
///   C = A⁻¹ (Σ_p g_p g_pᵀ N / (N − K) + Σ_q j_q j_qᵀ) A⁻¹
///   A = Σ_p J̃_pᵀ J̃_p + Σ_q j_q j_qᵀ     J̃_p: Jacobian of the other blocks, point p eliminated
///   g_p = J̃_pᵀ r_p                         r_p: residuals of p, robust kernels applied
/// with j_q the residuals without a point (priors; variance 1), N the number of residuals less three a point, K that of
/// the other unknowns (Liang and Zeger, "Longitudinal data analysis using generalized linear models", 1986). Of errors
/// without correlation this is σ² A⁻¹ in the mean. Correlations between points are not seen.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace ceres {
class Problem;
}

namespace bodyloom {

/// Parameter blocks of a bundle adjustment, none of them constant. A residual depends on one point at most.
struct BundleBlocks {
  std::vector<double*> others;  ///< cameras, focal length
  std::vector<double*> points;  ///< of three numbers, without a manifold
};

/// C's diagonal blocks, one for each of `others`: of the block's own numbers, also where it has a manifold. Empty if
/// the problem cannot be evaluated.
std::vector<Eigen::MatrixXd> BundleCovariances(ceres::Problem* problem, const BundleBlocks& blocks, int num_threads);

}  // namespace bodyloom
