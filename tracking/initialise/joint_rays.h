// SPDX-License-Identifier: Apache-2.0
/// Viewing rays for the search for 3D joints (joint_hypotheses.h): the rays of the detections, the lengths of the body,
/// and its depth.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/observations.h"
#include "tracking/initialise/joint_hypotheses.h"

namespace bodyloom::hypotheses_internal {

/// Indices of CocoNames().
enum Coco {
  kNose = 0,
  kLeftEye,
  kRightEye,
  kLeftEar,
  kRightEar,
  kLeftShoulder,
  kRightShoulder,
  kLeftHip = 11,
  kRightHip
};

constexpr std::array<int, 4> kTorso = {kLeftShoulder, kRightShoulder, kLeftHip, kRightHip};

/// One frame's detections as normalised rays (x/z, y/z) with confidences, in CocoNames() order.
struct Rays {
  std::array<Eigen::Vector2d, 17> ray;
  std::array<double, 17> confidence{};
  std::array<bool, 17> seen{};
  /// True if shoulders and hips are seen, and not all at one point.
  [[nodiscard]] bool has_torso() const {
    return seen[kLeftShoulder] && seen[kRightShoulder] && seen[kLeftHip] && seen[kRightHip] &&
           ((ray[kLeftShoulder] + ray[kRightShoulder]) - (ray[kLeftHip] + ray[kRightHip])).norm() > 1e-6;
  }
};

/// `keypoints` at these frames.
std::vector<Rays> RaysOfFrames(const KeypointSequence& keypoints, const Camera& camera, const std::vector<int>& frames,
                               const JointHypothesesOptions& options);

/// Lengths of the body that the hypotheses need, metres; `rest` are its 17 landmarks in the rest pose.
struct Lengths {
  double torso, upper[4], lower[4];
  MatrixX3d rest;
  explicit Lengths(const MatrixX3d& rest_points);
};

/// Depth of the root for every frame: body length over its apparent length, the apparent length being the 85th
/// percentile over ±1.5 s (foreshortening only shortens bones), smoothed over the same window.
std::vector<double> RootDepths(const std::vector<Rays>& rays, const std::vector<double>& times, const Lengths& lengths);

/// A squared error that saturates at `limit`.
inline double Saturated(double squared, double limit) { return limit * squared / (limit + squared); }

}  // namespace bodyloom::hypotheses_internal
