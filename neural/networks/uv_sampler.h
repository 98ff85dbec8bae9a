// SPDX-License-Identifier: Apache-2.0
/// Π of the renderers: what the pixels of an image see of a map that lies on the body. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

namespace bodyloom {

/// features: B×C×H×W, a UV map whose texel (r, c) is centred at u = (c + ½)/W, v = 1 − (r + ½)/H.
/// uv: B×2×h×w, u to the right and v upwards, in [0, 1]. mask: B×1×h×w, 0 off the body.
/// Returns B×C×h×w: mask · bilinear value of the map at (u, v), coordinates beyond the outermost texel centres clamped
/// to them; exactly 0 where mask is 0, whatever uv holds there (also NaN).
/// Differentiable in features, uv and mask; the gradient in uv is 0 where a coordinate was clamped, and that of a pixel
/// off the body is 0. Throws std::invalid_argument when shapes, types or devices do not fit together.
torch::Tensor SampleUv(const torch::Tensor& features, const torch::Tensor& uv, const torch::Tensor& mask);

}  // namespace bodyloom
