// SPDX-License-Identifier: Apache-2.0
/// A person's Gaussians (render/gaussian_avatar/gaussian_body.h) posed by a frame of a parametric body.
///
/// With six joints each, w = softmax of their logits, and j_k, R_k, p_k a joint's place at rest, rotation and place
/// now:
///   x = Σ_k w_k (R_k (position − j_k) + p_k) + φ · corrective of the anchor (barycentric)
///   A = Σ_k w_k R_k,   covariance factor F = A R(q) diag(e^(log scale))
///   o = 1/(1 + e^−logit)
///   colour = albedo · Σ_h L_h Y_h(n),   n = A n_c made unit length, in the light's frame
/// A is a blend, no rotation: it shears near a bent joint as the skin does.
///
/// Numbers that are not finite make the row's so, which ProjectGaussians leaves out.
///
/// Same bytes for any number of threads and any instruction set.
#pragma once

#include <array>
#include <string>

#include "geometry/math/arrays.h"
#include "render/gaussian_avatar/avatar_frame.h"
#include "render/gaussian_avatar/gaussian_body.h"
#include "render/gaussian_avatar/pose_simd.h"
#include "render/splat/camera_gaussians.h"

namespace bodyloom {

// How a person's Gaussians are posed (render/gaussian_avatar/pose_gaussians.h).

struct PoseGaussiansOptions {
  /// Rotation, row-major, from the frame of the posed Gaussians to the light's, for instance that of the camera that
  /// the light was learned in.
  std::array<float, 9> light_from_frame = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  int num_threads = 1;  ///< 1 to 1024
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// Fills `posed`, one row a Gaussian; keeps its memory. `faces`: the body's. Throws std::invalid_argument when the
/// options or the body (GaussianBody::IsValid) are not valid, tables differ in size, or a face names a vertex without a
/// corrective (frames without correctives are posed without).
void PoseGaussians(const GaussianBody& body, const MatrixX3i& faces, const AvatarFrame& frame,
                   const PoseGaussiansOptions& options, CameraGaussians* posed);

}  // namespace bodyloom

namespace bodyloom::avatar_internal {

// Checked arguments of posing, as plain arrays.

inline constexpr int kRowsAChunk = 1024;  ///< a multiple of kLanes; sums are taken chunk by chunk
inline int NumChunks(int num_rows) { return (num_rows + kRowsAChunk - 1) / kRowsAChunk; }

/// Throws as PoseGaussians does. The arguments must outlive the answer.
PoseTables TablesOf(const GaussianBody& body, const MatrixX3i& faces, const AvatarFrame& frame,
                    const PoseGaussiansOptions& options);

}  // namespace bodyloom::avatar_internal
