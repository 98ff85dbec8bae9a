// SPDX-License-Identifier: Apache-2.0
/// Balance: the zero-moment point of a person who moves slowly lies within what touches the ground.
///   ½ w ρ(‖H (c − s + z)‖² / σ²)        ρ: Geman–McClure with c = kBalanceKernel
/// c: centre of mass (geometry/body/centre_of_mass.h); s: the point nearest to the zero-moment point in the convex hull
/// of the touching points, a fixed combination of two of them; z = −c_v/(g + a_v) a_h: offset of the zero-moment point
/// from the centre of mass, of the states at the start of a round; H: the two horizontal axes. Only frames whose
/// zero-moment point lies outside of the hull have the term. The angular momentum is left out, which is right to a few
/// centimetres in slow motion and wrong by decimetres in fast motion, so w falls with the acceleration
/// (clip_balance.h). Translations cancel.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

#include "tracking/problem/body_points.h"
#include "tracking/problem/frame_term.h"

namespace bodyloom {

/// c of ρ, in σ: 40 cm, because somebody who leans by 20° has the zero-moment point 30 cm outside.
inline constexpr double kBalanceKernel = 10;

class BalanceTerm : public CopyableTerm<BalanceTerm> {
 public:
  const CompiledPoint* centre_of_mass = nullptr;  ///< borrowed; null: no term
  std::array<int, 2> vertices{};                  ///< s = share · first + (1 − share) · second
  double share = 1;
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();                            ///< z, camera axes
  Eigen::Matrix<double, 2, 3> horizontal = Eigen::Matrix<double, 2, 3>::Zero();  ///< H, camera axes
  double sigma_m = 0.04;                                                         ///< σ
  double weight = 0;                                                             ///< w

  [[nodiscard]] std::string name() const override { return "balance"; }
  [[nodiscard]] int num_rows() const override { return centre_of_mass != nullptr && weight > 0 ? 8 : 0; }
  void Add(FrameAccumulator* sums) const override;
};

}  // namespace bodyloom
