// SPDX-License-Identifier: Apache-2.0
/// Cost functions of a hand in one frame (hand_problem.h), whose parameter blocks are, in this order,
///   fingers    20 coordinates (hand_kinematics.h)
///   wrist      3: w of the wrist's rotation R_w exp(w), with R_w the body's
///   forearm    1: τ of the elbow's rotation R_e exp(τ a), with R_e the body's and a the forearm's axis: a twist that
///              leaves the wrist where it is
///   place      2: metres by which the hand seen lies to the right of and below the body's wrist, in the camera's axes
///   log size   1: logarithm of the size of the hand seen, relative to the body's
/// In the camera frame the points are W + (place, 0) + e^(log size) G q, with W the body's wrist, q of HandKinematics
/// and
///   G = E exp(τ a) R_w exp(w),   E the rotation of the elbow's axes to the camera's.
#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>

#include "geometry/scene/camera.h"
#include "tracking/hands/hand_kinematics.h"

namespace bodyloom {

/// The body's arm in one frame.
struct HandFrame {
  Camera camera;
  Eigen::Matrix3d camera_from_elbow = Eigen::Matrix3d::Identity();  ///< E
  Eigen::Vector3d forearm_axis = Eigen::Vector3d::UnitX();          ///< a, in the elbow's axes; length 1
  Eigen::Matrix3d wrist = Eigen::Matrix3d::Identity();              ///< R_w
  Eigen::Vector3d wrist_in_camera = Eigen::Vector3d::Zero();        ///< W
};

/// G, and the derivatives of its right increments.
struct HandTurn {
  HandTurn(const HandFrame& frame, const double* wrist, double forearm);
  Eigen::Matrix3d camera_from_wrist, by_wrist;
  Eigen::Vector3d by_forearm;
};

/// (pixel of point k − observed) / σ. Zero, with zero derivatives, where the point cannot be projected.
class HandPointCost : public ceres::SizedCostFunction<2, kFingerCoordinates, 3, 1, 2, 1> {
 public:
  /// Kinematics and frame are borrowed.
  HandPointCost(const HandKinematics* hand, const HandFrame* frame, int k, const Eigen::Vector2d& pixel,
                double sigma_px)
      : hand_(hand), frame_(frame), k_(k), pixel_(pixel), sigma_px_(sigma_px) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  const HandKinematics* hand_;
  const HandFrame* frame_;
  int k_;
  Eigen::Vector2d pixel_;
  double sigma_px_;
};

/// (direction from one point to another − observed) / σ, both of length 1 and in the camera's axes. Reads fingers,
/// wrist and forearm.
class HandBoneCost : public ceres::SizedCostFunction<3, kFingerCoordinates, 3, 1> {
 public:
  HandBoneCost(const HandKinematics* hand, const HandFrame* frame, int from, int to, const Eigen::Vector3d& direction,
               double sigma)
      : hand_(hand), frame_(frame), from_(from), to_(to), direction_(direction), sigma_(sigma) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  const HandKinematics* hand_;
  const HandFrame* frame_;
  int from_, to_;
  Eigen::Vector3d direction_;
  double sigma_;
};

/// HandLimitResiduals() of the free angles. Reads fingers.
class HandLimitCost : public ceres::SizedCostFunction<kFingerCoordinates, kFingerCoordinates> {
 public:
  explicit HandLimitCost(const HandKinematics* hand) : hand_(hand) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  const HandKinematics* hand_;
};

}  // namespace bodyloom
