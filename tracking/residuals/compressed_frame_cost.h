// SPDX-License-Identifier: Apache-2.0
/// A frame's cost as one Ceres cost function with at most p+1 rows for p parameters, however many observations it has.
///
/// With H = JᵀJ and g = Jᵀr of the frame's weighted residuals, the rows are R δ + y with RᵀR = H and y = R⁻ᵀ g, and one
/// last row √(2·cost − yᵀy) with zero Jacobian, which also carries the part of the robust kernels that a weighted
/// residual does not show, √Σ(ρ − ρ′s). Cost, gradient and Gauss–Newton step equal those of the full system; when only
/// residuals are requested, everything is in the last row.
#pragma once

#include <ceres/cost_function.h>
#include <ceres/evaluation_callback.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "bodyloom/tracking/frame_cost.h"

namespace bodyloom {

/// Parameter blocks: one 3-vector (axis-angle) for each active joint, translation (3), betas (if any), log focal length
/// (if estimated). Jacobians are with respect to the tangent (right increment) of each rotation block and must be used
/// with RotationManifold, whose PlusJacobian is the identity.
class CompressedFrameCost : public ceres::CostFunction {
 public:
  /// `held` gives the rotations of joints that are not active. Borrowed; must outlive the cost.
  CompressedFrameCost(const FrameLayout& layout, const FrameData& data, const FrameState& held);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  const FrameLayout& layout_;
  const FrameData& data_;
  const FrameState& held_;
};

/// All frames of a clip, evaluated together: Ceres evaluates once for each new point, the frames are spread over
/// threads, and its cost functions only hand out what lies ready. Ceres itself then runs on one thread: its own threads
/// add up gradients in the order in which they finish, which changes the last bits from run to run.
class FrameBatch : public ceres::EvaluationCallback {
 public:
  explicit FrameBatch(int num_threads) : num_threads_(num_threads) {}
  /// Takes a frame's cost and its parameter blocks; returns the cost function for the problem (which owns it).
  ceres::CostFunction* Add(std::unique_ptr<CompressedFrameCost> cost, std::vector<double*> blocks);
  void PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) override;

 private:
  struct Frame {
    std::unique_ptr<CompressedFrameCost> cost;
    std::vector<double*> blocks;
    std::vector<double> residuals, jacobian;  ///< jacobian: one (p+1)×size matrix after the other
    bool valid = false;
  };
  class HandOut;
  std::vector<std::unique_ptr<Frame>> frames_;
  int num_threads_;
  bool has_jacobians_ = false;
};

/// Upper triangular R with RᵀR = H (lower triangle of H is read) and y with Rᵀy = g, for positive semi-definite H with
/// g in its range; pivots below 1e-14 of the largest diagonal give zero rows.
void SquareRootSystem(const Eigen::MatrixXd& H, const Eigen::VectorXd& g, Eigen::MatrixXd* R, Eigen::VectorXd* y);

}  // namespace bodyloom
