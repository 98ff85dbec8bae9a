// SPDX-License-Identifier: Apache-2.0
/// Images as tensors and back. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include "render/image/image.h"

namespace bodyloom {

/// 8-bit BGR → 1×3×H×W RGB floats in [0, 1]. Throws std::invalid_argument for an empty image.
torch::Tensor ToTensor(const Image& image);

/// 3×H×W or 1×3×H×W RGB → 8 bits, ⌊255 x + ½⌋ with x clamped to [0, 1] (NaN: 0).
Image ToImage(const torch::Tensor& rgb);

/// B×C×H×W moved by (x, y) pixels, right and down; what comes in is zero. Where a window follows a person, this lays
/// the picture of the frame before over this one: (x, y) is where the window of that frame lies in this frame's.
torch::Tensor Shifted(const torch::Tensor& image, int x, int y);

}  // namespace bodyloom
