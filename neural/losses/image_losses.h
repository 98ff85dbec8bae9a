// SPDX-License-Identifier: Apache-2.0
/// Losses between images, labels and normals. Internal: includes LibTorch.
///
/// All are means over everything they count (batch, pixels, channels), so that weights keep their meaning when the size
/// of an image changes. Tensors of one call have the same shape (masks: one channel), type and device; std::
/// invalid_argument otherwise. Source of what is compared: Yoon et al., CVPR 2022, Section 3.2, which leaves the norms
/// open; L1 is this project's choice.
#pragma once

#include <torch/torch.h>

namespace bodyloom {

/// mean |a − b|.
torch::Tensor L1Loss(const torch::Tensor& a, const torch::Tensor& b);

/// Σ m |a − b| / (C Σ m): the mean over the pixels that count; m is B×1×H×W, ≥ 0. Exactly 0, with zero gradient,
/// where no pixel counts. Values where m = 0 may be anything, also NaN.
torch::Tensor MaskedL1Loss(const torch::Tensor& a, const torch::Tensor& b, const torch::Tensor& mask);

/// L_s: mean |softmax(logits) − labels| over pixels and classes; labels are B×K×H×W probabilities (one-hot or soft).
torch::Tensor SoftLabelL1Loss(const torch::Tensor& logits, const torch::Tensor& labels);

/// Cross entropy −Σ_k labels_k log softmax(logits)_k, mean over pixels.
torch::Tensor SoftLabelCrossEntropy(const torch::Tensor& logits, const torch::Tensor& labels);

/// B×H×W class numbers 0 … K−1 → B×K×H×W one-hot floats; other numbers give a column of zeros.
torch::Tensor OneHot(const torch::Tensor& classes, int num_classes);

}  // namespace bodyloom
