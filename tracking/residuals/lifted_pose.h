// SPDX-License-Identifier: Apache-2.0
/// L_d of paper A when the initialiser is the lifter: landmarks relative to the mid-hip should be where it says, each
/// as firmly as its own uncertainty allows.
///   ½ w Σ_k ρ(‖W_k (x_k − ½(x_left_hip + x_right_hip) − y_k)‖²)     ρ: Geman–McClure
/// W_k = R diag(1/σ_xy, 1/σ_xy, 1/σ_z) Rᵀ with R the axes in which the lifter looked. Depth is what it is asked for,
/// and across the view the image knows better: σ_xy is rarely what decides.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/tracking/body_points.h"
#include "bodyloom/tracking/initialise/lift_keypoints.h"

namespace bodyloom {

/// The lifter's landmarks, compiled for a body.
struct LiftedLandmarks {
  std::array<CompiledPoint, LifterOutput::kPoints> points;
  std::array<bool, LifterOutput::kPoints> known{};  ///< the body has it
  /// Both hips, both shoulders and a way to measure the body's length: without them nothing can be lifted.
  [[nodiscard]] bool IsUsable() const;
};
LiftedLandmarks CompileLiftedLandmarks(const BodyModel& model, int num_betas);

struct LiftedPose {
  struct Point {
    int landmark = 0;
    Eigen::Vector3d offset;     ///< from the mid-hip, camera axes, metres
    Eigen::Matrix3d whitening;  ///< 1/m
  };
  const LiftedLandmarks* landmarks = nullptr;
  std::vector<Point> points;
};

/// `metres` is the body's torso + leg length, `min_sigma_m` a floor of both scales: the body's landmarks are not the
/// detector's.
LiftedPose MakeLiftedPose(const LiftedFrame& frame, const LiftedLandmarks& landmarks, double metres,
                          double min_sigma_m);

}  // namespace bodyloom
