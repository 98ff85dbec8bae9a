// SPDX-License-Identifier: Apache-2.0
/// A person's Gaussians (render/avatar/gaussian_body.h) posed by a frame of a parametric body.
///
/// With six joints each, w = softmax of their logits, and j_k, R_k, p_k a joint's place at rest, rotation and place now:
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

#include "bodyloom/geometry/arrays.h"
#include "bodyloom/render/avatar/avatar_frame.h"
#include "bodyloom/render/avatar/gaussian_body.h"
#include "bodyloom/render/avatar/pose_options.h"
#include "bodyloom/render/splat/camera_gaussians.h"

namespace bodyloom {

/// Fills `posed`, one row a Gaussian; keeps its memory. `faces`: the body's. Throws std::invalid_argument when the
/// options or the body (GaussianBody::IsValid) are not valid, tables differ in size, or a face names a vertex without a
/// corrective (frames without correctives are posed without).
void PoseGaussians(const GaussianBody& body, const MatrixX3i& faces, const AvatarFrame& frame,
                   const PoseGaussiansOptions& options, CameraGaussians* posed);

}  // namespace bodyloom
