// SPDX-License-Identifier: Apache-2.0
/// Known colours, carried on over the garment that they belong to. Internal: includes LibTorch.
///
///   x_k = PullPush(Ĩ, S̃ [G̃ = k]),   x = x_k where G = k and k is known somewhere in the picture,
///                                        PullPush(Ĩ, S̃) elsewhere
/// So a skirt's rim takes its colour from the skirt on the thigh, not from the stocking beside it. Where the pixel
/// itself is known under its label the colour is its own.
#pragma once

#include <torch/torch.h>

namespace bodyloom {

/// image: B×3×H×W, known: B×1×H×W of zeros and ones (Ĩ, S̃), known_classes and classes: B×1×H×W class numbers (G̃, G;
/// `classes` may be undefined: every pixel then takes what is nearest). Returns B×3×H×W. No gradient.
torch::Tensor CarryColours(const torch::Tensor& image, const torch::Tensor& known, const torch::Tensor& known_classes,
                           const torch::Tensor& classes);

}  // namespace bodyloom
