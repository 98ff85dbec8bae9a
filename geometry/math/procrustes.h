// SPDX-License-Identifier: Apache-2.0
/// Least-squares alignment of two point sets by a rotation, a translation and, optionally, one scale.
///
///   minimises Σ_i w_i ‖target_i − (s R source_i + t)‖²  over R in SO(3), t, and s (similarity) or s = 1 (rigid).
///
/// With weighted means removed, Σ_i w_i target_i source_iᵀ = U diag(σ) Vᵀ:
///   R = U D Vᵀ,  D = diag(1, 1, sign det(U Vᵀ)),  s = (σ·D) / Σ w_i ‖source_i‖²,  t = mean_target − s R mean_source.
/// R is a rotation even when the target is a mirror image of the source (the determinant is corrected on the last
/// singular vector).
///
/// Source: Umeyama, "Least-squares estimation of transformation parameters between two point patterns", PAMI 1991.
#pragma once

#include <Eigen/Core>
#include <string>

#include "geometry/math/arrays.h"

namespace bodyloom {

/// x ↦ scale · rotation · x + translation.
struct SimilarityTransform {
  double scale = 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  /// N×3 points mapped row by row.
  [[nodiscard]] MatrixX3d Apply(const MatrixX3d& points) const;
};

enum class AlignmentStatus {
  kNoPoints,   ///< no usable pair: the transform is the identity
  kAmbiguous,  ///< one point, coinciding or collinear points: the rotation is not determined and left at identity
  kUnique,     ///< the rotation is determined
};
std::string ToString(AlignmentStatus status);

struct AlignmentOptions {
  bool estimate_scale = true;     ///< false: rigid, s = 1
  double collinear_ratio = 1e-9;  ///< ambiguous when σ₂ ≤ ratio·σ₁: the cross-covariance has rank one
};

struct AlignmentResult {
  SimilarityTransform target_from_source;
  AlignmentStatus status = AlignmentStatus::kNoPoints;
  int num_points = 0;  ///< pairs used
};

/// The transform that takes `source` (N×3) onto `target` (N×3). A pair with a non-finite coordinate on either side or
/// a weight that is zero or not finite is left out. `weights` has N non-negative entries, or none for equal weights.
/// In the ambiguous case the scale is the ratio of the two sets' spreads (1 when the source has none, or when the
/// scale is not estimated) and the translation matches the means.
/// Throws std::invalid_argument when sizes differ or a weight is negative.
AlignmentResult AlignPoints(const MatrixX3d& source, const MatrixX3d& target, const AlignmentOptions& options = {},
                            const Eigen::VectorXd& weights = {});

}  // namespace bodyloom
