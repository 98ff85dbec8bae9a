// SPDX-License-Identifier: Apache-2.0
/// Converts images to tensors and back. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include "render/image/image.h"

namespace bodyloom {

/// 8-bit BGR → 1×3×H×W RGB floats in [0, 1]. Throws std::invalid_argument for an empty image.
torch::Tensor ToTensor(const Image& image);

/// 3×H×W or 1×3×H×W RGB → 8 bits, ⌊255 x + ½⌋ with x clamped to [0, 1] (NaN: 0).
Image ToImage(const torch::Tensor& rgb);

/// Shifts B×C×H×W by (x, y) pixels, right and down, with zero padding. For windows that follow a person it aligns the
/// previous frame with the current one: (x, y) is the position of the previous window in the current one.
torch::Tensor Shifted(const torch::Tensor& image, int x, int y);

}  // namespace bodyloom
