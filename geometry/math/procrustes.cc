// SPDX-License-Identifier: Apache-2.0
#include "geometry/math/procrustes.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

#include "geometry/base/check.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;

MatrixX3d SimilarityTransform::Apply(const MatrixX3d& points) const {
  return (scale * points * rotation.transpose()).rowwise() + translation.transpose();
}

std::string ToString(AlignmentStatus status) {
  switch (status) {
    case AlignmentStatus::kNoPoints:
      return "no points";
    case AlignmentStatus::kAmbiguous:
      return "ambiguous";
    case AlignmentStatus::kUnique:
      return "unique";
  }
  return "unknown";
}

AlignmentResult AlignPoints(const MatrixX3d& source, const MatrixX3d& target, const AlignmentOptions& options,
                            const Eigen::VectorXd& weights) {
  const Eigen::Index n = source.rows();
  BODYLOOM_CHECK(target.rows() == n, "AlignPoints: source has ", n, " points, target has ", target.rows());
  BODYLOOM_CHECK(weights.size() == 0 || weights.size() == n, "AlignPoints: ", weights.size(), " weights for ", n,
                 " points");
  BODYLOOM_CHECK(weights.size() == 0 || !(weights.array() < 0).any(), "AlignPoints: a weight is negative");

  const auto weight_of = [&](Eigen::Index i) {
    const double w = weights.size() == 0 ? 1.0 : weights[i];
    return std::isfinite(w) && source.row(i).allFinite() && target.row(i).allFinite() ? w : 0.0;
  };
  AlignmentResult result;
  double total_weight = 0;
  Vector3d mean_source = Vector3d::Zero(), mean_target = Vector3d::Zero();
  for (Eigen::Index i = 0; i < n; ++i) {
    const double w = weight_of(i);
    if (w == 0) continue;
    total_weight += w;
    mean_source += w * source.row(i).transpose();
    mean_target += w * target.row(i).transpose();
    ++result.num_points;
  }
  if (result.num_points == 0) return result;
  mean_source /= total_weight;
  mean_target /= total_weight;

  Matrix3d cross = Matrix3d::Zero();
  double spread_source = 0, spread_target = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double w = weight_of(i);
    if (w == 0) continue;
    const Vector3d a = source.row(i).transpose() - mean_source, b = target.row(i).transpose() - mean_target;
    cross.noalias() += w * b * a.transpose();
    spread_source += w * a.squaredNorm();
    spread_target += w * b.squaredNorm();
  }

  // A spread within rounding error of coinciding points counts as zero.
  constexpr double kRounding2 = 1e-28;
  if (spread_source <= kRounding2 * total_weight * mean_source.squaredNorm()) spread_source = 0;
  if (spread_target <= kRounding2 * total_weight * mean_target.squaredNorm()) spread_target = 0;

  SimilarityTransform& transform = result.target_from_source;
  const Eigen::JacobiSVD<Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector3d& sigma = svd.singularValues();
  if (spread_source == 0 || spread_target == 0 || sigma[1] <= options.collinear_ratio * sigma[0]) {
    result.status = AlignmentStatus::kAmbiguous;
    if (options.estimate_scale && spread_source > 0) transform.scale = std::sqrt(spread_target / spread_source);
  } else {
    result.status = AlignmentStatus::kUnique;
    const Matrix3d& U = svd.matrixU();
    const Matrix3d& V = svd.matrixV();
    const Vector3d d(1, 1, (U * V.transpose()).determinant() < 0 ? -1.0 : 1.0);
    transform.rotation = U * d.asDiagonal() * V.transpose();
    if (options.estimate_scale) transform.scale = sigma.dot(d) / spread_source;
  }
  transform.translation = mean_target - transform.scale * transform.rotation * mean_source;
  return result;
}

}  // namespace bodyloom
