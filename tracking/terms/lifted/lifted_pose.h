// SPDX-License-Identifier: Apache-2.0
/// L_d of paper A with the lifter as initialiser: distance of the landmarks relative to the mid-hip from its
/// predictions, weighted by their uncertainty.
///   ½ w Σ_k ρ(‖W_k (x_k − ½(x_left_hip + x_right_hip) − y_k)‖²)     ρ: Geman–McClure
/// W_k = R diag(1/σ_xy, 1/σ_xy, 1/σ_z) Rᵀ with R the axes of the lifter's virtual camera. It adds information mainly on
/// depth; across the view the image is more accurate, so σ_xy has little effect.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "tracking/initialise/lifted_landmarks.h"
#include "tracking/lifter/lift_keypoints.h"
#include "tracking/problem/frame_term.h"

namespace bodyloom {

class ClipTerm;
struct ClipTermInput;
struct PlanEntry;
struct TrackSequenceInput;
struct TrackSequenceOptions;

struct LiftedPose {
  struct Point {
    int landmark = 0;
    Eigen::Vector3d offset;         ///< from the mid-hip, camera axes, metres
    Eigen::Vector2d inverse_sigma;  ///< 1/m: across and along the view
    Eigen::Vector2d variance;       ///< m²: of the lifter's density, 4 σ_xy² and 4 σ_z² (lifter_reading.h)
  };
  const LiftedLandmarks* landmarks = nullptr;
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< R
  std::vector<Point> points;  ///< in the order of the landmarks, those that the body lacks left out

  /// W_k, 1/m.
  [[nodiscard]] Eigen::Matrix3d Whitening(const Point& point) const { return Turned(point.inverse_sigma); }
  /// m²: of a body joint's position about the middle of the hips, by the landmark nearest to it
  /// (LiftedLandmarks::Nearest): share² times that landmark's covariance.
  [[nodiscard]] Eigen::Matrix3d JointCovariance(int joint) const;

 private:
  /// R diag(x, x, z) Rᵀ. Matrices of every point of every frame would be three quarters of the memory.
  [[nodiscard]] Eigen::Matrix3d Turned(const Eigen::Vector2d& across_and_along) const;
};

/// `metres` is the body's torso + leg length, `min_sigma_m` a floor of both scales: the body's landmarks are not the
/// detector's.
LiftedPose MakeLiftedPose(const LiftedFrame& frame, const LiftedLandmarks& landmarks, double metres,
                          double min_sigma_m);

class LiftedPoseTerm : public CopyableTerm<LiftedPoseTerm> {
 public:
  const LiftedPose* pose = nullptr;  ///< borrowed; null: none
  double weight = 0;                 ///< w
  double kernel = 3;                 ///< c of ρ, in σ

  [[nodiscard]] bool runs() const { return pose != nullptr && weight > 0; }
  [[nodiscard]] std::string name() const override { return "lifter"; }
  [[nodiscard]] int num_rows() const override { return runs() ? static_cast<int>(3 * pose->points.size()) + 3 : 0; }
  void Add(FrameAccumulator* sums) const override;
};

std::vector<PlanEntry> PlanLifted(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::unique_ptr<ClipTerm> MakeLiftedPoseTerms(const ClipTermInput& clip);

}  // namespace bodyloom
