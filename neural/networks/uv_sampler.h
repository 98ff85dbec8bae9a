// SPDX-License-Identifier: Apache-2.0
/// Π of the renderers: samples a UV map of the body at the pixels of an image. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

namespace bodyloom {

/// features: B×C×H×W, a UV map whose texel (r, c) is centred at u = (c + ½)/W, v = 1 − (r + ½)/H.
/// uv: B×2×h×w, u to the right and v upwards, in [0, 1]. mask: B×1×h×w, 0 off the body.
/// Returns B×C×h×w: mask · bilinear value of the map at (u, v), coordinates beyond the outermost texel centres are
/// clamped to them; exactly 0 where mask is 0, for any uv there (also NaN).
/// Differentiable in features, uv and mask; the gradient in uv is 0 where a coordinate was clamped, and that of a pixel
/// off the body is 0. Throws std::invalid_argument when shapes, types or devices do not fit together.
torch::Tensor SampleUv(const torch::Tensor& features, const torch::Tensor& uv, const torch::Tensor& mask);

// Fills unknown pixels of an image from nearby known ones.
//
//   pull: m₀ = mask, x₀ = x;  m' = mean of m over 2×2 pixels, x' = (mean of m x over them)/m' where m' > 0, else 0;
//         then m' ← 1 where m' > 0
//   push: from the coarsest level on, a pixel with m = 1 keeps its x, the others take the coarser level's, upsampled
//         bilinearly
// Source: Gortler et al., "The Lumigraph", SIGGRAPH 1996, Section 3.4.

/// `x`: B×C×H×W, `mask`: B×1×H×W of zeros and ones. Halves up to `levels` times, as long as both sides are even. Where
/// the mask is 1 the result is x itself; x is ignored where it is 0; without any 1 nearby the result is 0. The gradient
/// flows into x where the mask is 1. Throws std::invalid_argument for other shapes.
torch::Tensor PullPush(const torch::Tensor& x, const torch::Tensor& mask, int levels);

}  // namespace bodyloom
