// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/initialise/limb_costs.h"

#include <algorithm>
#include <cmath>

namespace bodyloom::hypotheses_internal {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// The point of the ray at distance `length` from `start`, nearer or farther; the closest one if none is.
Vector3d OnRay(const Vector2d& ray, const Vector3d& start, double length, bool far) {
  const Vector3d d = Vector3d(ray.x(), ray.y(), 1).normalized();
  const double along = d.dot(start), discriminant = along * along - start.squaredNorm() + length * length;
  if (discriminant <= 0) return along * d;
  return (along + (far ? 1 : -1) * std::sqrt(discriminant)) * d;
}

/// A joint behind the torso is detected with low confidence (0.1), one in front with high (0.7).
double Occlusion(double confidence, const Vector3d& point, const Matrix3d& torso, const Vector3d& centre) {
  const Vector3d offset = point - centre, up = torso.col(1);
  const Vector3d across = offset - up * up.dot(offset);
  const double sideways = std::hypot(across.x(), across.y());
  const bool hidden = sideways < 0.16 && std::abs(up.dot(offset)) < 0.35 && offset.z() > 0.09;
  const double expected = hidden ? 0.12 : 0.7;
  const double z = (std::min(confidence, 0.7) - expected) / 0.25;
  return Saturated(z * z, 4);
}

}  // namespace

LimbCosts::LimbCosts(const PosePrior* prior, const Lengths& lengths, const JointHypothesesOptions& options)
    : lengths_(lengths), options_(options) {
  if (prior != nullptr && prior->num_directions > 0) {
    prior_ = prior;
    bins_.emplace(prior->num_directions);
  }
}

/// −log density of a limb's two unit bone directions in the torso frame; 0 for the most common ones is not implied.
double LimbCosts::Density(int limb, Vector3d upper, Vector3d lower) const {
  if (prior_ == nullptr) return 0;
  if (limb % 2 == 1) {
    upper.x() = -upper.x();
    lower.x() = -lower.x();
  }
  const RowMatrixXf& table = limb < 2 ? prior_->arm_log_density : prior_->leg_log_density;
  return -table(bins_->Nearest(upper), bins_->Nearest(lower));
}

void LimbCosts::Hypotheses(const Rays& rays, int limb, const Vector3d& start, Vector3d middle[4],
                           Vector3d end[4]) const {
  for (int h = 0; h < 4; ++h) {
    middle[h] = OnRay(rays.ray[kLimbs[limb][1]], start, lengths_.upper[limb], (h & 1) != 0);
    end[h] = OnRay(rays.ray[kLimbs[limb][2]], middle[h], lengths_.lower[limb], (h & 2) != 0);
  }
}

double LimbCosts::Cost(const Rays& rays, int limb, const Matrix3d& torso, const Vector3d& torso_centre,
                       const Vector3d& start, const Vector3d& middle, const Vector3d& end) const {
  double cost = options_.density_weight * Density(limb, torso.transpose() * (middle - start).normalized(),
                                                  torso.transpose() * (end - middle).normalized());
  if (limb < 2) {
    cost += options_.occlusion_weight * (Occlusion(rays.confidence[kLimbs[limb][1]], middle, torso, torso_centre) +
                                         Occlusion(rays.confidence[kLimbs[limb][2]], end, torso, torso_centre));
  }
  return cost;
}

}  // namespace bodyloom::hypotheses_internal
