// SPDX-License-Identifier: Apache-2.0
#include "neural/losses/contextual_loss.h"

#include <ATen/CPUGeneratorImpl.h>

#include <algorithm>
#include <vector>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using torch::Tensor;

constexpr int64_t kRowsAtOnce = 1024;  // bounds the memory when no gradient is requested

/// B×C×h×w → B×C×N, a random subset of N = max_points positions if there are more.
Tensor Points(const Tensor& features, const ContextualOptions& options) {
  Tensor points = features.flatten(2);
  if (options.max_points == 0 || points.size(2) <= options.max_points) return points;
  const torch::Generator generator = at::make_generator<at::CPUGeneratorImpl>(options.seed);
  const Tensor order = torch::randperm(points.size(2), generator, torch::kLong);
  return points.index_select(2, order.slice(0, 0, options.max_points).to(points.device()));
}

/// Normalises to unit length over channels; a zero vector (a feature equal to the target's mean) stays zero.
Tensor Directions(const Tensor& points) { return points * (points.square().sum(1, true) + 1e-20).rsqrt(); }

/// CX of one pair, C×N and C×M.
Tensor SimilarityOf(const Tensor& image, const Tensor& target, double bandwidth) {
  std::vector<Tensor> best;
  for (int64_t first = 0; first < image.size(1); first += kRowsAtOnce) {
    const Tensor rows = image.slice(1, first, std::min(first + kRowsAtOnce, image.size(1)));
    const Tensor distance = ((1 - torch::mm(rows.t(), target)) / 2).clamp_min(0);
    const Tensor relative = distance / (distance.amin({1}, true) + 1e-5);
    const Tensor similarity = torch::softmax((1 - relative) / bandwidth, 1);  // w_ij / Σ_k w_ik
    best.push_back(similarity.amax({0}));
  }
  return torch::stack(best).amax({0}).mean();
}

}  // namespace

Tensor ContextualSimilarity(const Tensor& features, const Tensor& target, const ContextualOptions& options) {
  BODYLOOM_CHECK(features.dim() == 4 && target.dim() == 4 && features.size(0) == target.size(0) &&
                     features.size(1) == target.size(1) && features.numel() > 0 && target.numel() > 0,
                 "contextual similarity: features of shapes ", features.sizes(), " and ", target.sizes(),
                 ", expected B x C x h x w with the same B and C");
  BODYLOOM_CHECK(options.bandwidth > 0 && options.max_points >= 0, "contextual similarity: bandwidth ",
                 options.bandwidth, " and ", options.max_points, " points, expected > 0 and >= 0");
  const Tensor centre = target.mean({0, 2, 3}, true);
  const Tensor image_points = Directions(Points(features - centre, options));
  const Tensor target_points = Directions(Points(target - centre, options));
  std::vector<Tensor> similarities;
  for (int64_t b = 0; b < features.size(0); ++b) {
    similarities.push_back(SimilarityOf(image_points[b], target_points[b], options.bandwidth));
  }
  return torch::stack(similarities);
}

Tensor ContextualLoss(const Tensor& features, const Tensor& target, const ContextualOptions& options) {
  return -ContextualSimilarity(features, target, options).log().mean();
}

}  // namespace bodyloom
