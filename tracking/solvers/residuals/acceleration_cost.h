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

// Penalty on velocities (L_t of paper A, Σ ‖θ_t − θ_{t±1}‖ + ‖C_t − C_{t±1}‖, squared and per second).
//
// Rotation: r = log(R₀ᵀR₁)/Δ / σ, angular velocity of a joint relative to its parent, rad/s. Vector: (x₁ − x₀)/Δ / σ.
// Δ is the frames' time step in seconds. Two consecutive frames; never used across a gap or a cut. Unlike the penalty
// on accelerations it damps fast motion; it suits people who hardly move, and is off by default.

/// Derivatives of log(R₀ᵀR₁) by right increments of R₀ and R₁, given its RightJacobianInverse.
void RotationStepJacobians(const Eigen::Matrix3d& right, Eigen::Matrix3d J[2]);

/// Blocks: axis-angle of one joint at two frames (RotationManifold; derivatives by right increments).
class RotationVelocityCost : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  RotationVelocityCost(double dt, double sigma);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  double scale_;  ///< 1/(Δ σ)
};

/// Blocks: a 3-vector at two frames, one σ a component.
class VectorVelocityCost : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  VectorVelocityCost(double dt, const double sigma[3]);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  Eigen::Vector3d scale_;
};

}  // namespace bodyloom
