// SPDX-License-Identifier: Apache-2.0
/// Backpropagates through render/gaussian_avatar/pose_gaussians.h: derivatives of a loss by the person's parameters,
/// the light, and the bones, from which a pose can be refined.
///
/// Derivatives are complete: position, shape and normal all depend on the blended bone and thus on skinning weights and
/// bones. Only the skin's corrective, a few millimetres that depend on the pose, is treated as constant.
///
/// Sums over Gaussians are computed in chunks that depend on their number alone: the same bytes for any number of
/// threads and any instruction set.
#pragma once

#include <array>
#include <vector>

#include "geometry/math/arrays.h"
#include "render/gaussian_avatar/pose_gaussians.h"

namespace bodyloom {

struct AvatarGradient {
  FloatColumns parameters;  ///< columns of GaussianBody::parameters
  std::array<float, GaussianBody::kLightValues> light{};
  /// J × 12: rows of [d loss/d R_k | d loss/d p_k], entry by entry (R_k as nine independent numbers).
  std::vector<float> bones;
};

/// Keeps its memory between frames. Not for use by two threads at once.
class PoseGradient {
 public:
  /// The arguments of PoseGaussians, and `by_posed`: d loss/d posed, columns of CameraGaussians. A row whose
  /// derivatives are all zero gets zeros and contributes nothing, even if its values are not finite. Throws as
  /// PoseGaussians.
  void Compute(const GaussianBody& body, const MatrixX3i& faces, const AvatarFrame& frame,
               const PoseGaussiansOptions& options, const FloatColumns& by_posed, AvatarGradient* gradient);

 private:
  FloatColumns sums_;  ///< a column per chunk: derivatives by the light (27 × lanes), then by the bones
};

}  // namespace bodyloom
