// SPDX-License-Identifier: Apache-2.0
/// Fills what is not known of an image with what is known nearby. Internal: includes LibTorch.
///
///   pull: m₀ = mask, x₀ = x;  m' = mean of m over 2×2 pixels, x' = (mean of m x over them)/m' where m' > 0, else 0;
///         then m' ← 1 where m' > 0
///   push: from the coarsest level on, a pixel with m = 1 keeps its x, the others take the level above, enlarged
///         bilinearly
/// Source: Gortler et al., "The Lumigraph", SIGGRAPH 1996, Section 3.4.
#pragma once

#include <torch/torch.h>

namespace bodyloom {

/// `x`: B×C×H×W, `mask`: B×1×H×W of zeros and ones. Halves up to `levels` times, as long as both sides are even. Where
/// the mask is 1 the result is x itself; where it is 0, x is not looked at; without any 1 nearby it is 0. The gradient
/// flows into x where the mask is 1. Throws std::invalid_argument for other shapes.
torch::Tensor PullPush(const torch::Tensor& x, const torch::Tensor& mask, int levels);

}  // namespace bodyloom
