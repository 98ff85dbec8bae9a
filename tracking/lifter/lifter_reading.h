// SPDX-License-Identifier: Apache-2.0
/// Decodes landmarks, hypotheses and their uncertainty from the lifter's outputs.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/lifter_weights.h"

namespace bodyloom {

/// One hypothesis for the landmarks LifterOutput::LimbPoints(limb) of a limb.
struct LiftedLimb {
  double weight = 0;                      ///< probability; the hypotheses of a limb sum to 1
  std::array<Eigen::Vector3d, 4> points;  ///< as LiftedFrame::points
  std::array<Eigen::Vector2d, 4> sigma;
};

struct LiftedFrame {
  bool seen = false;  ///< the frame shows at least one landmark; otherwise it is interpolated from its neighbours
  Eigen::Matrix3d camera_from_virtual = Eigen::Matrix3d::Identity();
  /// 21×3 relative to the mid-hip, camera axes, in units of the body's torso + leg length. Limbs: MeanLimb().
  MatrixX3d points;
  /// 21×2: scale of the error across and along the view, same units (density: lifter_weights.h).
  Eigen::Matrix<double, Eigen::Dynamic, 2> sigma;
  std::array<std::vector<LiftedLimb>, LifterOutput::kLimbs> limbs;
  Eigen::Vector3d up = Eigen::Vector3d(0, -1, 0);  ///< world up, camera axes, unit
  double up_sigma = 1;
  Eigen::Vector2d contact = Eigen::Vector2d::Zero();  ///< probability that the left and the right foot stand
};

/// Features of the mirrored clip: left and right exchanged, x negated.
RowMatrixXf MirrorFeatures(const RowMatrixXf& features);

/// Decodes one frame (row) of RunLifter()'s output for a clip's features, and for its mirrored features when `mirrored`
/// has rows: torso landmarks, up and contact are averaged, the limbs' hypotheses are concatenated. `seen` stays false.
LiftedFrame ReadLifter(const RowMatrixXf& plain, const RowMatrixXf& mirrored, Eigen::Index row,
                       const Eigen::Matrix3d& camera_from_virtual);

/// Turns the landmarks and the limbs' hypotheses about the mid-hip; `up` and `camera_from_virtual` stay.
void TurnLandmarks(const Eigen::Matrix3d& turn, LiftedFrame* frame);

/// Writes a limb's hypothesis into the frame's points and sigma.
void SetLimb(int limb, const LiftedLimb& guess, LiftedFrame* frame);
/// Expected limb: the weighted mean of its hypotheses, which has the minimum expected error where they disagree about
/// the depth. Its sigma covers them: σ² = Σ w (σ_m² + d_m²/4), with d_m the hypothesis's distance to the mean across
/// (of one axis) and along the view (a coordinate's variance under the lifter's density is 4 σ²). Weight 1.
LiftedLimb MeanLimb(const std::vector<LiftedLimb>& guesses, const Eigen::Matrix3d& camera_from_virtual);

/// P(|error| ≤ radius) under the lifter's density (neural/lifter/lifter_module.h): the error is r (σ_xy u_x,
/// σ_xy u_y, σ_z u_z) with u uniform on the sphere and r ~ Gamma(3), so P = ∫₀¹ F(radius / √(σ_xy²(1 − c²) + σ_z² c²))
/// dc with F(r) = 1 − e^{−r}(1 + r + r²/2).
double ProbabilityWithin(double radius, const Eigen::Vector2d& sigma);

}  // namespace bodyloom
