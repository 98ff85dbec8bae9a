// SPDX-License-Identifier: Apache-2.0
/// Nothing below the ground, and something on it: heights of surface points above the ground of the person.
///   ½ w Σ_k s_k ρ((h_k / σ)²)               a point that touches the ground
/// + ½ w Σ_k s_k ρ((min(0, h_k) / σ)²)       any other point near it
/// + ½ w_h w Σ_k ρ_h(‖P (x_k + o − a_k)‖² / σ_h²)   a point that is held (clip_contacts.h: HeldPlaces())
/// h_k = u · (x_k + o) − l − r_k, metres: u the vertical, l the level of the ground, o = FrameLayout::BodyPlace, r_k
/// the height of a sole's point above the lowest of a foot that stands flat; ρ: Geman–McClure with
/// c = kSurfaceContactKernel; s_k = σ² / (σ² + σ_k²), σ_k² the variance of the ground's height at the point
/// (FrameGround::HeightVariance), since a wrong vertical raises one end of a path or of somebody who lies, and lowers
/// the other; P: onto two directions across u; a_k: the place where the point is held; w_h = kHoldWeight as a rule,
/// because the points of a foot err together; ρ_h: as ρ, with kHoldKernel. Which points touch is found in
/// clip_contacts.h and kept during a solve. Runs in frames of a shot whose ground is known.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "tracking/problem/frame_term.h"

namespace bodyloom {

inline constexpr double kSurfaceContactKernel = 4;  ///< c of ρ, in σ
inline constexpr double kHoldKernel = 3, kHoldWeight = 0.3;

class SurfaceContactTerm : public CopyableTerm<SurfaceContactTerm> {
 public:
  struct Contact {
    int vertex = 0;
    bool touches = false;
    double rest_m = 0;                           ///< r
    double share = 1;                            ///< s
    std::optional<Eigen::Vector3d> held_m = {};  ///< a, camera axes
  };
  Eigen::Vector3d up = Eigen::Vector3d(0, -1, 0);  ///< u, camera axes, unit
  double level_m = 0;                              ///< l
  double sigma_m = 0.02;                           ///< σ
  double hold_sigma_m = 0.03;                      ///< σ_h
  double hold_weight = kHoldWeight;                ///< w_h
  double weight = 0;                               ///< w
  std::vector<Contact> contacts;

  [[nodiscard]] std::string name() const override { return "surface on the ground"; }
  [[nodiscard]] int num_rows() const override {
    return weight > 0 && !contacts.empty() ? 3 * static_cast<int>(contacts.size()) + 3 : 0;
  }
  void Add(FrameAccumulator* sums) const override;
};

}  // namespace bodyloom
