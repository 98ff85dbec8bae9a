// SPDX-License-Identifier: Apache-2.0
/// Computes the Cramér–Rao bound of a clip, the best accuracy that a fit can have, propagated to pixels.
///
/// With residuals r(x) of unit variance, independent and Gaussian, any unbiased estimate of x has
///   Cov(x̂) ⪰ Λ⁻¹,  Λ = JᵀJ,  J = ∂r/∂x at the truth,
/// and to first order a vertex' pixel has covariance Σ_v = J_v Λ⁻¹ J_vᵀ (2×2), J_v = ∂pixel/∂x. Priors add their own
/// information to Λ (the Bayesian bound). Outliers are not in the model: with a fraction ε of useless observations the
/// information is (1 − ε) times as large.
///
/// Parameters are T frames of p values, followed by s values shared by all frames (shape, focal length). Frames couple
/// to their `bandwidth` nearest neighbours (0: only through the shared ones, 1: velocities, 2: accelerations), so all
/// marginal covariances come out in O(T) without the T·p × T·p inverse.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <string>
#include <vector>

namespace bodyloom {

/// Λ by blocks.
struct ClipInformation {
  std::vector<std::vector<Eigen::MatrixXd>> band;  ///< band[k][t]: p×p block (t, t + k), k = 0…bandwidth, T − k of them
  std::vector<Eigen::MatrixXd> coupling;           ///< T of p×s: frame t with the shared parameters
  Eigen::MatrixXd shared;                          ///< s×s (s may be 0)
  [[nodiscard]] int num_frames() const { return band.empty() ? 0 : static_cast<int>(band[0].size()); }
};

/// The blocks of a symmetric sparse Λ of size num_frames·frame_size + s, frames first; only the upper triangle is read.
/// The bandwidth is found. Throws std::invalid_argument when the size does not fit.
ClipInformation ClipInformationFromSparse(const Eigen::SparseMatrix<double>& information, int num_frames,
                                          int frame_size);

/// Blocks of Λ⁻¹.
struct ClipCovariance {
  bool is_finite = false;              ///< false: Λ is singular, some parameter is not observed
  std::string message;                 ///< which frames, when not finite
  std::vector<Eigen::MatrixXd> frame;  ///< T of p×p
  std::vector<Eigen::MatrixXd> cross;  ///< T of p×s
  Eigen::MatrixXd shared;              ///< s×s
  /// (p+s)×(p+s) covariance of frame t's parameters followed by the shared ones.
  [[nodiscard]] Eigen::MatrixXd WithShared(int t) const;
};

/// By block elimination along the chain, then the shared parameters' Schur complement, then backwards for the diagonal
/// blocks of the inverse. Throws std::invalid_argument when block sizes disagree.
ClipCovariance MarginalCovariances(const ClipInformation& information);

/// E‖e‖ of e ~ N(0, covariance) in the plane: √(2λ₁/π) · E(√(1 − λ₂/λ₁)) with eigenvalues λ₁ ≥ λ₂ and the complete
/// elliptic integral of the second kind E. Isotropic: σ√(π/2); along a line: σ√(2/π).
double ExpectedNorm(const Eigen::Matrix2d& covariance);

/// Expected per-vertex projection error, pixels.
struct ProjectionBound {
  double mean_px = 0;  ///< mean over frames and vertices of E‖e_v‖: compare with the mean of a fit
  double rms_px = 0;   ///< √ mean tr Σ_v: compare with its root mean square
  int num_vertices = 0;
};

/// Gathers the bound over frames: Add() takes d_pixel_d_parameters (2V×n: rows x and y of vertex 0, then of vertex 1 …)
/// and the n×n covariance of those parameters, for example ClipCovariance::WithShared(t).
class ProjectionBoundAccumulator {
 public:
  void Add(const Eigen::MatrixXd& d_pixel_d_parameters, const Eigen::MatrixXd& covariance);
  /// The bound in pixels times `scale` (SquareImageScale of data_tools/evaluation/metrics_image.h for images of
  /// 512×512).
  [[nodiscard]] ProjectionBound Result(double scale = 1) const;

 private:
  double sum_norm_ = 0, sum_square_ = 0;
  int num_vertices_ = 0;
};

}  // namespace bodyloom
