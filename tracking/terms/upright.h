// SPDX-License-Identifier: Apache-2.0
/// The trunk does not lean towards or away from the camera.
///   ½ w ρ((n·u)² / σ²)        ρ: Geman–McClure with c = kUprightKernel, σ = kUprightSigma
/// u: the root's up axis in the camera frame; n: horizontal, towards the scene. A camera barely sees this lean (cos is
/// flat), and people are mostly upright. It saturates, so bending and lying stay free. n is the view's direction until
/// the clip's own vertical is known (terms/ground_contact/clip_ground.h). Runs in every frame whose root is estimated.
#pragma once

#include <Eigen/Core>
#include <string>

namespace bodyloom {

class FrameAccumulator;
struct PlanEntry;
struct TrackSequenceInput;
struct TrackSequenceOptions;

inline constexpr double kUprightSigma = 0.25, kUprightKernel = 1.5;

struct UprightOfFrame {
  double weight = 0;                                  ///< w
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< n: the direction in which it should not lean

  [[nodiscard]] static int num_rows() { return 0; }  ///< adds to the matrix directly
  void Add(FrameAccumulator* sums) const;
};

/// Why the clip's vertical is not used, or empty when it is.
std::string WhyNoUp(const TrackSequenceInput& input, const TrackSequenceOptions& options);
PlanEntry PlanUp(const TrackSequenceInput& input, const TrackSequenceOptions& options);

}  // namespace bodyloom
