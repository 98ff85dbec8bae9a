// SPDX-License-Identifier: Apache-2.0
/// Poses a person's Gaussians (render/gaussian_avatar/gaussian_body.h) by a frame of a parametric body.
///
/// With six joints per Gaussian, w the softmax of their logits, and j_k, R_k, p_k a joint's rest position, rotation and
/// posed position:
///   x = Σ_k w_k (R_k (position − j_k) + p_k) + φ · corrective of the anchor (barycentric)
///   A = Σ_k w_k R_k,   covariance factor F = A R(q) diag(e^(log scale))
///   o = 1/(1 + e^−logit)
///   colour = albedo · Σ_h L_h Y_h(n),   n = A n_c made unit length, in the light's frame
/// A is a blend of rotations, in general not a rotation: it shears near bent joints as the skin does.
///
/// Rows with numbers that are not finite give such results, which ProjectGaussians leaves out.
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

struct PoseGaussiansOptions {
  /// Rotation, row-major, from the frame of the posed Gaussians to that of the light, for instance the camera in which
  /// the light was learned.
  std::array<float, 9> light_from_frame = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  int num_threads = 1;  ///< 1 to 1024
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// Fills `posed`, one row per Gaussian; reuses its memory. `faces`: the body's. Throws std::invalid_argument when the
/// options or the body (GaussianBody::IsValid) are not valid, tables differ in size, or a face has a vertex without a
/// corrective (frames without any correctives are valid).
void PoseGaussians(const GaussianBody& body, const MatrixX3i& faces, const AvatarFrame& frame,
                   const PoseGaussiansOptions& options, CameraGaussians* posed);

}  // namespace bodyloom

namespace bodyloom::avatar_internal {

// Arguments of posing as plain arrays, after checks.

inline constexpr int kRowsAChunk = 1024;  ///< a multiple of kLanes; sums are computed per chunk
inline int NumChunks(int num_rows) { return (num_rows + kRowsAChunk - 1) / kRowsAChunk; }

/// Throws as PoseGaussians does. The arguments must outlive the result.
PoseTables TablesOf(const GaussianBody& body, const MatrixX3i& faces, const AvatarFrame& frame,
                    const PoseGaussiansOptions& options);

}  // namespace bodyloom::avatar_internal
