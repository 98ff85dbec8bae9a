// SPDX-License-Identifier: Apache-2.0
/// Losses between images, labels and normals. Internal: includes LibTorch.
///
/// All are means over batch, pixels and channels, so that weights do not depend on the image size. Tensors of one call
/// have the same shape (masks: one channel), type and device; std:: invalid_argument otherwise. Source of the terms:
/// Yoon et al., CVPR 2022, Section 3.2, which leaves the norms open; L1 is this project's choice.
#pragma once

#include <torch/torch.h>
#include <vector>

#include "geometry/base/check.h"

namespace bodyloom {

/// mean |a − b|.
torch::Tensor L1Loss(const torch::Tensor& a, const torch::Tensor& b);

/// Σ m |a − b| / (C Σ m): the weighted mean over pixels; m is B×1×H×W, ≥ 0. Exactly 0, with zero gradient, if m = 0
/// everywhere. Values where m = 0 may be arbitrary, also NaN.
torch::Tensor MaskedL1Loss(const torch::Tensor& a, const torch::Tensor& b, const torch::Tensor& mask);

/// L_s: mean |softmax(logits) − labels| over pixels and classes; labels are B×K×H×W probabilities (one-hot or soft).
torch::Tensor SoftLabelL1Loss(const torch::Tensor& logits, const torch::Tensor& labels);

/// Cross entropy −Σ_k labels_k log softmax(logits)_k, mean over pixels.
torch::Tensor SoftLabelCrossEntropy(const torch::Tensor& logits, const torch::Tensor& labels);

/// B×H×W classes 0 … K−1 → B×K×H×W one-hot floats; all zeros for other numbers.
torch::Tensor OneHot(const torch::Tensor& classes, int num_classes);

// Perceptual loss: difference of two images in the features of a network.
//
// Takes features instead of images, so that those of a constant target are computed once:
//   FeatureNetwork vgg(options);
//   const auto target = vgg(image);          // under torch::NoGradGuard, kept
//   loss = PerceptualLoss(vgg(prediction), target);

/// Σ_i w_i mean |features_i − target_i|; w_i = 1 when no weights are given.
inline torch::Tensor PerceptualLoss(const std::vector<torch::Tensor>& features,
                                    const std::vector<torch::Tensor>& targets,
                                    const std::vector<double>& weights = {}) {
  BODYLOOM_CHECK(
      !features.empty() && features.size() == targets.size() && (weights.empty() || weights.size() == features.size()),
      "perceptual loss: ", features.size(), " features, ", targets.size(), " targets and ", weights.size(),
      " weights, expected as many of each (or no weights)");
  torch::Tensor loss;
  for (size_t i = 0; i < features.size(); ++i) {
    torch::Tensor term = L1Loss(features[i], targets[i]);
    if (!weights.empty()) term = weights[i] * term;
    loss = i == 0 ? term : loss + term;
  }
  return loss;
}

/// Divergence of N(μ, σ²) from N(0, 1): −½ Σ (1 + log σ² − μ² − σ²), summed over a sample's numbers, mean over the
/// batch (the first dimension).
inline torch::Tensor KlLoss(const torch::Tensor& mean, const torch::Tensor& log_variance) {
  BODYLOOM_CHECK(mean.sizes() == log_variance.sizes() && mean.dim() >= 1 && mean.size(0) > 0,
                 "KL loss: means of shape ", mean.sizes(), " and log variances of shape ", log_variance.sizes());
  return -0.5 * (1 + log_variance - mean.square() - log_variance.exp()).sum() / mean.size(0);
}

}  // namespace bodyloom
