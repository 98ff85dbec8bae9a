// SPDX-License-Identifier: Apache-2.0
/// Smoothness in time (L_t of paper A, by acceleration instead of velocity so that fast motion is not damped).
///
/// Rotation: r = [ log(R₁ᵀR₂)/Δ₁ − log(R₀ᵀR₁)/Δ₀ ] / ((Δ₀+Δ₁)/2) / σ, angular acceleration of a joint relative to its
/// parent, rad/s². Vector: the same with x₂ − x₁ and x₁ − x₀. Δ are the frames' time steps in seconds, so frame rate
/// and irregular time stamps need no special care. Three consecutive frames; never used across a gap or a cut.
#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>

namespace bodyloom {

/// r = (later · second step − earlier · first step) / σ.
struct AccelerationFactors {
  double earlier = 0, later = 0;  ///< 2/((Δ₀+Δ₁) Δ₀), 2/((Δ₀+Δ₁) Δ₁)
  static AccelerationFactors Of(double dt0, double dt1);
};

/// Derivatives of σ r by right increments of R₀, R₁, R₂, given RightJacobianInverse of log(R₀ᵀR₁) and of log(R₁ᵀR₂).
void RotationAccelerationJacobians(const AccelerationFactors& factors, const Eigen::Matrix3d& right0,
                                   const Eigen::Matrix3d& right1, Eigen::Matrix3d J[3]);

/// Blocks: axis-angle of one joint at three frames (RotationManifold; derivatives by right increments).
class RotationAccelerationCost : public ceres::SizedCostFunction<3, 3, 3, 3> {
 public:
  RotationAccelerationCost(double dt0, double dt1, double sigma);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  AccelerationFactors factors_;  ///< divided by σ
};

/// Blocks: a 3-vector at three frames, one σ a component.
class VectorAccelerationCost : public ceres::SizedCostFunction<3, 3, 3, 3> {
 public:
  VectorAccelerationCost(double dt0, double dt1, const double sigma[3]);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  double scale0_[3], scale1_[3];
};

}  // namespace bodyloom
