// SPDX-License-Identifier: Apache-2.0
/// Losses between images, labels and normals. Internal: includes LibTorch.
///
/// All are means over batch, pixels and channels, so that weights do not depend on the image size. Tensors of one call
/// have the same shape (masks: one channel), type and device; std:: invalid_argument otherwise. Source of the terms:
/// Yoon et al., CVPR 2022, Section 3.2, which leaves the norms open; L1 is this project's choice.
#pragma once

#include <torch/torch.h>
#include <cstdint>
#include <span>
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

// GAN losses of discriminator and generator from logits D.
//
//   kNonSaturating: discriminator ½ (mean softplus(−D(real)) + mean softplus(D(fake))), generator mean
//     softplus(−D(fake)) (binary cross entropy; Goodfellow et al. 2014, its non-saturating form for the generator);
//   kLeastSquares: ½ (mean (D(real) − 1)² + mean D(fake)²), mean (D(fake) − 1)² (Mao et al. 2017).
// Several scales are summed, as Wang et al., CVPR 2018 do.
//
// In the discriminator's step pass D(fake.detach()); in the generator's step disable requires_grad of the
// discriminator's parameters to avoid computing their gradients.

enum class GanLossKind { kNonSaturating, kLeastSquares };

/// One tensor of logits per scale, of any shape; as many real as fake, at least one.
torch::Tensor DiscriminatorLoss(const std::vector<torch::Tensor>& real_logits,
                                const std::vector<torch::Tensor>& fake_logits,
                                GanLossKind kind = GanLossKind::kNonSaturating);
torch::Tensor GeneratorLoss(const std::vector<torch::Tensor>& fake_logits,
                            GanLossKind kind = GanLossKind::kNonSaturating);

// Contextual similarity and loss of two sets of features that need not be aligned.
//
// Features are centred by the target's mean over batch and positions and normalised to unit length over channels. For
// positions i of the image and j of the target, with the cosine c_ij:
//   d_ij = (1 − c_ij)/2,  d̃_ij = d_ij / (min_k d_ik + 1e-5),  w_ij = exp((1 − d̃_ij)/h),  CX_ij = w_ij / Σ_k w_ik,
//   CX = mean_j max_i CX_ij  (1 if every target feature occurs in the image),  loss = −log CX, mean over the batch.
// Sources: Mechrez et al., "The Contextual Loss for Image Transformation with Non-Aligned Data", ECCV 2018, and its
// published code (h = 0.5); the evaluation code of Men et al., CVPR 2020 (ADGAN; h = 0.1).

struct ContextualOptions {
  double bandwidth = 0.5;  ///< h: 0.5 for the loss as published, 0.1 for ADGAN's metric
  /// Positions beyond this number are subsampled at random (65² as in the published code); 0: use all. Memory of the
  /// backward pass grows quadratically.
  int64_t max_points = 65 * 65;
  uint64_t seed = 0;  ///< of the subsampling; images and targets of the same size use the same positions
};

/// B×C×h×w and B×C×h'×w' → CX of each of the B pairs, in (0, 1].
torch::Tensor ContextualSimilarity(const torch::Tensor& features, const torch::Tensor& target,
                                   const ContextualOptions& options = {});

/// mean_b −log CX_b.
torch::Tensor ContextualLoss(const torch::Tensor& features, const torch::Tensor& target,
                             const ContextualOptions& options = {});

/// Weights that bring losses to the scale of a reference loss, determined once and then constant.
///
/// During the first `warmup` steps the losses are measured; then λ_i = mean(reference)/mean(loss_i), clamped to [1e-3,
/// 1e2], for the rest of the run (0 for a loss that was 0 throughout). Yoon et al., CVPR 2021, choose theirs
/// "empirically … that all the losses have comparable scale" without stating them.
class LossBalance {
 public:
  LossBalance(int num_losses, int warmup);

  /// Adds a step of the warm-up; does nothing after it.
  void Measure(double reference, std::span<const double> losses);
  [[nodiscard]] bool IsSet() const;
  /// 0 until the weights are set.
  [[nodiscard]] double Weight(int loss) const;

  /// State for a checkpoint, as doubles: steps measured, sums (the reference's first), weights.
  [[nodiscard]] torch::Tensor* state() { return &state_; }

 private:
  int num_losses_, warmup_;
  torch::Tensor state_;
};

}  // namespace bodyloom
