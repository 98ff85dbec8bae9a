// SPDX-License-Identifier: Apache-2.0
/// Uncertainty of the joints' positions, from the normal equations of the solve and, where the lifter ran, from the
/// covariance of its prediction (docs/tracking.md, "Uncertainty").
///
/// With D_j the derivative of joint j by a frame's columns and by the shared values, D_h that of the middle of the hip
/// joints and P the covariance of these values (chain/chain_inverse.h), the measurements give
///   E_j = (D_j − D_h) P (D_j − D_h)ᵀ       about the middle of the hips,   E_h = D_h P D_hᵀ for that middle itself.
/// Without the lifter C_j = E_j. The lifter's density has the covariance L_j (terms/lifted/lifted_pose.h), which is
/// learned from detectors' errors and from the depth ambiguity of a single image; the cost models neither. So P is
/// computed without the lifter's term, and both are joined,
///   C_j = ((n E_j)⁻¹ + L_j⁻¹)⁻¹ + f² I,
/// with n = 4, because the coarse frames' detections are not independent, and f = 1 cm, because the model's body
/// differs from the person's and its joints from the detector's; both chosen on motion outside all test sets
/// (docs/lab/joint_sigma.md). The standard deviation of one axis is σ_j = √(trace(C_j) / 3).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/track.h"
#include "tracking/problem/sequence_problem.h"
#include "tracking/terms/lifted/lifted_pose.h"

namespace bodyloom {

/// Covariances of a frame's joints by its normal equations, in the axes of the state, m².
struct JointSpread {
  std::vector<Eigen::Matrix3d> about_hips;  ///< J: of a joint's position relative to the middle of the hip joints
  /// Of that middle. For weak perspective the depth of the whole body is not part of it.
  Eigen::Matrix3d hips = Eigen::Matrix3d::Zero();
  /// √(trace(E_h) / 3), metres.
  [[nodiscard]] double HipsSigma() const;
};

/// From the covariance P of the frame's columns and the shared values. For a body without joints named l_hip and r_hip
/// the root joint is their middle.
JointSpread JointSpreadOf(const FrameLayout& layout, const FrameState& state, const Eigen::VectorXd& betas,
                          const Eigen::MatrixXd& P);

/// J standard deviations σ_j, metres, with C_j = E_j.
Eigen::VectorXd JointSigmaOf(const JointSpread& spread);
/// The same with both joined; `camera_from_state` rotates the state's axes to those of the frame's camera.
Eigen::VectorXd JointSigmaOf(const JointSpread& spread, const LiftedPose& lifted,
                             const Eigen::Matrix3d& camera_from_state);
/// The same for the lifter alone: C_j = L_j + f² I.
Eigen::VectorXd JointSigmaOf(const LiftedPose& lifted, int num_joints);

/// Standard deviations of positions, metres, one axis.
struct PositionSigma {
  RowMatrixXd joints;    ///< T×J: σ_j, about the middle of the hips
  Eigen::VectorXd hips;  ///< T: JointSpread::HipsSigma(), for a person whose stature is as assumed
  /// Covariance of the unknowns that all frames share, in the layout's columns from beta_column on.
  Eigen::MatrixXd shared;

  /// NaN everywhere.
  static PositionSigma Unknown(Eigen::Index num_frames, int num_joints);
};

/// For the problem at its current state, with shape and focal length unknown. Observations, priors and smoothness have
/// the weights of the cost, so a limb that was not observed has the standard deviation of the prior. NaN where the
/// system is singular. Linear in the number of frames; the same bytes for any number of threads. `focal_log_sigma`,
/// unless null, is set to the standard deviation of the logarithm of the focal length; it is unchanged when the focal
/// length is known or the system singular. `shared`: the covariance of the shared unknowns, of a problem of part
/// of a clip; null: the problem tells it.
PositionSigma PositionSigmaOf(SequenceProblem problem, int num_threads, double* focal_log_sigma = nullptr,
                              const Eigen::MatrixXd* shared = nullptr);

/// The same, with memory for `window` frames at once (WindowsOf()), more than kWindowOverlap: a SequenceSample of as
/// many tells the covariance of the shared unknowns, and each frame's comes from the window to whose ends it is less
/// near. Not for problems with couplings.
PositionSigma PositionSigmaInWindows(const SequenceProblem& problem, int window, int num_threads,
                                     double* focal_log_sigma = nullptr);

/// Standard deviation of the logarithm of the focal length by the whole problem's normal equations, without the frames'
/// covariances; NaN when it is known or the system singular.
double FocalLogSigmaOf(const SequenceProblem& problem, int num_threads);

/// Adds the uncertainty of a focal length that was held during the solve, `log_sigma` of its logarithm, to root_sigma
/// of a track: the distance z from the camera is proportional to it, so σ² becomes σ² + (log_sigma z)²/3.
void AddFocalSpread(double log_sigma, Track* track);

}  // namespace bodyloom
