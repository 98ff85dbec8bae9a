// SPDX-License-Identifier: Apache-2.0
/// Velocities cost something (L_t of paper A, Σ ‖θ_t − θ_{t±1}‖ + ‖C_t − C_{t±1}‖, squared and by seconds).
///
/// Rotation: r = log(R₀ᵀR₁)/Δ / σ, angular velocity of a joint relative to its parent, rad/s. Vector: (x₁ − x₀)/Δ / σ.
/// Δ is the frames' time step in seconds. Two consecutive frames; never used across a gap or a cut. Beside the
/// accelerations (acceleration_cost.h) it damps fast motion: a choice for still people, off unless asked for.
#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>

namespace bodyloom {

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
