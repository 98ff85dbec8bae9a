// SPDX-License-Identifier: Apache-2.0
/// The way back through render/gaussian_avatar/pose_gaussians.h: derivatives of a loss by the person's parameters, by
/// the light, and by the bones, from which a pose can be refined.
///
/// Everything of the forward formulas is followed: place, shape and normal all reach the blended bone and through it
/// the skin weights and the bones. The corrective of the skin is taken as given (it is a function of the pose too, of
/// millimetres; a derivative by the pose leaves it out).
///
/// Sums over Gaussians are taken by chunks that depend on their number alone: the same bytes for any number of threads
/// and any instruction set.
#pragma once

#include <array>
#include <vector>

#include "geometry/math/arrays.h"
#include "render/gaussian_avatar/pose_gaussians.h"

namespace bodyloom {

struct AvatarGradient {
  FloatColumns parameters;  ///< columns of GaussianBody::parameters
  std::array<float, GaussianBody::kLightValues> light{};
  /// J × 12: rows of [d loss/d R_k | d loss/d p_k], entry by entry (R_k as nine free numbers).
  std::vector<float> bones;
};

/// Keeps its memory between frames. Not for use by two threads at once.
class PoseGradient {
 public:
  /// The arguments of PoseGaussians, and `by_posed`: d loss/d posed, columns of CameraGaussians. A row whose
  /// derivatives are all zero gets zeros and gives nothing, whatever it holds. Throws as PoseGaussians.
  void Compute(const GaussianBody& body, const MatrixX3i& faces, const AvatarFrame& frame,
               const PoseGaussiansOptions& options, const FloatColumns& by_posed, AvatarGradient* gradient);

 private:
  FloatColumns sums_;  ///< a column a chunk: by the light's 27 × lanes, then by the bones
};

}  // namespace bodyloom
