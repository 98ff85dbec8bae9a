// SPDX-License-Identifier: Apache-2.0
/// Standing feet: holds a point of the foot at the position of its stance.
///   ½ ρ(‖W (x + o − a)‖²)                ρ: Geman–McClure
/// x: the point relative to the body's origin, o = FrameLayout::BodyPlace, so a is in the frame's camera frame, metres,
/// for every kind of camera. W = diag(1/σ_slide, 1/σ_slide, 1/σ_height) in axes whose third is the ground's normal,
/// times the root of the weight. a lies on the ground; it is an estimate of initialise/ground_plane.h and constant
/// here, so that frames are not coupled. Derivatives: ∂x/∂θ of tracking/problem/body_points.h; ∂o/∂t = I, and for weak
/// perspective ∂o/∂(log s, tx, ty) = (−o_z e_z, e_x, e_y). Runs in frames in which clip_ground.h found a standing foot.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tracking/problem/body_points.h"
#include "tracking/problem/frame_term.h"

namespace bodyloom {

struct PlanEntry;
struct TrackSequenceInput;
struct TrackSequenceOptions;

struct GroundContact {
  const CompiledPoint* point = nullptr;
  Eigen::Vector3d target_m = Eigen::Vector3d::Zero();       ///< a
  Eigen::Matrix3d whitening = Eigen::Matrix3d::Identity();  ///< W, 1/m
};

inline constexpr double kContactKernel = 3;  ///< c of ρ, in σ

class GroundContactTerm : public CopyableTerm<GroundContactTerm> {
 public:
  std::vector<GroundContact> feet;

  [[nodiscard]] std::string name() const override { return "standing feet"; }
  [[nodiscard]] int num_rows() const override { return static_cast<int>(3 * feet.size()); }
  void Add(FrameAccumulator* sums) const override;
};

/// The reason why no ground is estimated; empty if one is.
std::string WhyNoGround(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::vector<PlanEntry> PlanGround(const TrackSequenceInput& input, const TrackSequenceOptions& options);

}  // namespace bodyloom
