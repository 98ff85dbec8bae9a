// SPDX-License-Identifier: Apache-2.0
/// Contextual similarity and loss of two sets of features that need not be aligned. Internal: includes LibTorch.
///
/// Features are centred by the target's mean over batch and positions and normalised to unit length over channels. For
/// positions i of the image and j of the target, with the cosine c_ij:
///   d_ij = (1 − c_ij)/2,  d̃_ij = d_ij / (min_k d_ik + 1e-5),  w_ij = exp((1 − d̃_ij)/h),  CX_ij = w_ij / Σ_k w_ik,
///   CX = mean_j max_i CX_ij  (1 if every target feature occurs in the image),  loss = −log CX, mean over the batch.
/// Sources: Mechrez et al., "The Contextual Loss for Image Transformation with Non-Aligned Data", ECCV 2018, and its
/// published code (h = 0.5); the evaluation code of Men et al., CVPR 2020 (ADGAN; h = 0.1).
#pragma once

#include <torch/torch.h>

#include <cstdint>

namespace bodyloom {

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

}  // namespace bodyloom
