// SPDX-License-Identifier: Apache-2.0
/// Finds how two cameras stand to each other, and their clocks, from the motion of one person as each camera saw it
/// alone.
///
/// With a_i and b_i the person's points about their centre at the times t_i of clock a and t_i + τ of clock b, on a
/// common grid, the rotation R(τ) and the mean squared distance d(τ) are
///   d(τ) = min over R of  1/(n K) Σ_i Σ_k ‖R a_ik − b_ik‖²     (n moments that both show, K points)
/// and the offset maximises n(τ) log(d₀ / max(d(τ), d₁)), the logarithm of the likelihood ratio of Gaussian errors
/// whose size is what is left of the motion: long overlaps that agree are preferred to short ones, but a short one that
/// agrees well to a long one that hardly does. d₀, the squared distance of poses that have nothing to do with each
/// other, is the median of d over all offsets, and at least (15 cm)²; d₁ = (3 cm)², for no two tracks agree better by
/// more than chance. It is refined to a 240th of a second. The translation is the median of c_b − R c_a, with c the
/// centres. The body has the same size in both, so the metre is the body's.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"

namespace bodyloom {

/// Points of a person over time, in the frame of one camera.
struct ViewMotion {
  std::vector<double> timestamps;  ///< T seconds, strictly increasing
  std::vector<MatrixX3d> points;   ///< T of K×3 metres; not finite where the person is not known
};

/// The points at a moment, interpolated; false where they are not known, or not for 0.3 s around it.
bool PointsAt(const ViewMotion& motion, double time, MatrixX3d* points);

struct MotionAlignment {
  bool found = false;
  std::string why;  ///< the reason when it is not
  CameraPose b_from_a;
  double offset_s = 0;          ///< clock b minus clock a
  double offset_sigma_s = 0;    ///< of the offset; of a person who stands still as long as the clips
  double distance_m = 0;        ///< √d at the offset
  double other_distance_m = 0;  ///< √d₀
  double overlap_s = 0;         ///< time that both show
  /// Of a motion that repeats itself: offset less offset_s of the other moment, more than half a second away, at which
  /// the motions agree best; there they must agree as well, or for three seconds within a tenth as well. NaN: none.
  double repeat_s = std::numeric_limits<double>::quiet_NaN();
  double score = 0;  ///< n (d₀ − d) in m² s
};

/// Not found when less than a second (or a third of the shorter clip, if that is less) is shown by both, and when the
/// motions differ: √d above kMaxMotionDistance_m, or for overlaps of less than 3 s (or 80 % of the shorter clip) above
/// the same share of it, since two short motions are similar at some moment. Throws std::invalid_argument for a motion
/// without frames, timestamps that do not increase, or unequal numbers of points.
MotionAlignment AlignMotions(const ViewMotion& a, const ViewMotion& b);

/// Two tracks of the same dancer differ by 30 to 163 mm, those of different ones by 204 to 297
/// (docs/lab/two_views.md).
inline constexpr double kMaxMotionDistance_m = 0.18;

}  // namespace bodyloom
