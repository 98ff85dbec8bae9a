// SPDX-License-Identifier: Apache-2.0
/// Landmarks, hypotheses and their uncertainty from the lifter's outputs.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/lifter_weights.h"

namespace bodyloom {

/// One guess for the landmarks LifterOutput::LimbPoints(limb) of a limb.
struct LiftedLimb {
  double weight = 0;                      ///< probability; the hypotheses of a limb sum to 1
  std::array<Eigen::Vector3d, 4> points;  ///< as LiftedFrame::points
  std::array<Eigen::Vector2d, 4> sigma;
};

struct LiftedFrame {
  bool seen = false;  ///< the frame shows at least one landmark; otherwise its neighbours speak for it
  Eigen::Matrix3d camera_from_virtual = Eigen::Matrix3d::Identity();
  /// 21×3 relative to the mid-hip, camera axes, in units of the body's torso + leg length. Limbs: MeanLimb().
  MatrixX3d points;
  /// 21×2: scale of the error across and along the view, same units (lifter_weights.h says of which density).
  Eigen::Matrix<double, Eigen::Dynamic, 2> sigma;
  std::array<std::vector<LiftedLimb>, LifterOutput::kLimbs> limbs;
  Eigen::Vector3d up = Eigen::Vector3d(0, -1, 0);  ///< world up, camera axes, unit
  double up_sigma = 1;
  Eigen::Vector2d contact = Eigen::Vector2d::Zero();  ///< probability that the left and the right foot stand
};

/// Features of the same clip seen in a mirror: left and right exchanged, x turned round.
RowMatrixXf MirrorFeatures(const RowMatrixXf& features);

/// One frame (row) of RunLifter()'s output for a clip's features, and for its mirrored features when `mirrored` has
/// rows: torso landmarks, up and contact are averaged, the limbs' hypotheses stand side by side. `seen` is left false.
LiftedFrame ReadLifter(const RowMatrixXf& plain, const RowMatrixXf& mirrored, Eigen::Index row,
                       const Eigen::Matrix3d& camera_from_virtual);

/// Takes a limb's guess into the frame's points and sigma.
void SetLimb(int limb, const LiftedLimb& guess, LiftedFrame* frame);
/// What is expected of a limb: the mean of its guesses by weight. Where they disagree the picture leaves the depth
/// open, and the mean errs least; its sigma covers them: σ² = Σ w (σ_m² + d_m²/4), with d_m the guess's distance to the
/// mean across (of one axis) and along the view (a coordinate's variance under the lifter's density is 4 σ²). Weight 1.
LiftedLimb MeanLimb(const std::vector<LiftedLimb>& guesses, const Eigen::Matrix3d& camera_from_virtual);

/// P(|error| ≤ radius) of the density that the lifter states (neural/lifter/lifter_loss.h): the error is r (σ_xy u_x,
/// σ_xy u_y, σ_z u_z) with u uniform on the sphere and r ~ Gamma(3), so P = ∫₀¹ F(radius / √(σ_xy²(1 − c²) + σ_z² c²))
/// dc with F(r) = 1 − e^{−r}(1 + r + r²/2).
double ProbabilityWithin(double radius, const Eigen::Vector2d& sigma);

}  // namespace bodyloom
