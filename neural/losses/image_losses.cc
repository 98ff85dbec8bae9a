// SPDX-License-Identifier: Apache-2.0
#include "neural/losses/image_losses.h"

#include <ATen/CPUGeneratorImpl.h>
#include <algorithm>

namespace bodyloom {
namespace {

constexpr double kMinimum = 1e-3, kMaximum = 1e2;

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

/// Loss of logits with the label "real" (or "fake").
torch::Tensor Distance(const torch::Tensor& logits, bool real, GanLossKind kind) {
  if (kind == GanLossKind::kLeastSquares) return (real ? logits - 1 : logits).square().mean();
  return torch::softplus(real ? -logits : logits).mean();
}

void CheckAlike(const char* name, const torch::Tensor& a, const torch::Tensor& b) {
  BODYLOOM_CHECK(a.sizes() == b.sizes() && a.scalar_type() == b.scalar_type() && a.device() == b.device(), name,
                 ": shapes ", a.sizes(), " (", a.scalar_type(), ") and ", b.sizes(), " (", b.scalar_type(),
                 "), expected the same shape, type and device");
}

void CheckLabels(const char* name, const torch::Tensor& logits, const torch::Tensor& labels) {
  BODYLOOM_CHECK(logits.dim() == 4, name, ": logits of shape ", logits.sizes(), ", expected B x K x H x W");
  CheckAlike(name, logits, labels);
}

}  // namespace

torch::Tensor L1Loss(const torch::Tensor& a, const torch::Tensor& b) {
  CheckAlike("L1 loss", a, b);
  return (a - b).abs().mean();
}

torch::Tensor MaskedL1Loss(const torch::Tensor& a, const torch::Tensor& b, const torch::Tensor& mask) {
  CheckAlike("masked L1 loss", a, b);
  BODYLOOM_CHECK(a.dim() == 4 && mask.dim() == 4 && mask.size(0) == a.size(0) && mask.size(1) == 1 &&
                     mask.size(2) == a.size(2) && mask.size(3) == a.size(3),
                 "masked L1 loss: a mask of shape ", mask.sizes(), " for images of shape ", a.sizes());
  // Masked values are replaced before the difference: 0 · NaN would be NaN, also in the gradient.
  const torch::Tensor zero = torch::zeros({}, a.options());
  const torch::Tensor counts = mask != 0;
  const torch::Tensor difference = (torch::where(counts, a, zero) - torch::where(counts, b, zero)).abs();
  const torch::Tensor total = mask.sum() * a.size(1);
  return (mask * difference).sum() / torch::where(total > 0, total, torch::ones({}, total.options()));
}

torch::Tensor SoftLabelL1Loss(const torch::Tensor& logits, const torch::Tensor& labels) {
  CheckLabels("label loss", logits, labels);
  return (torch::softmax(logits, 1) - labels).abs().mean();
}

torch::Tensor SoftLabelCrossEntropy(const torch::Tensor& logits, const torch::Tensor& labels) {
  CheckLabels("cross entropy", logits, labels);
  return -(labels * torch::log_softmax(logits, 1)).sum(1).mean();
}

torch::Tensor OneHot(const torch::Tensor& classes, int num_classes) {
  BODYLOOM_CHECK(classes.dim() == 3 && num_classes > 0, "one-hot: classes of shape ", classes.sizes(), " and ",
                 num_classes, " classes, expected B x H x W and 1 or more");
  const torch::Tensor numbers = torch::arange(num_classes, classes.options()).view({1, num_classes, 1, 1});
  return (classes.unsqueeze(1) == numbers).to(torch::kFloat);
}

torch::Tensor DiscriminatorLoss(const std::vector<torch::Tensor>& real_logits,
                                const std::vector<torch::Tensor>& fake_logits, GanLossKind kind) {
  BODYLOOM_CHECK(!real_logits.empty() && real_logits.size() == fake_logits.size(), "discriminator loss: logits of ",
                 real_logits.size(), " scales for real and ", fake_logits.size(),
                 " for fake images, expected as many, at least one");
  torch::Tensor loss;
  for (size_t s = 0; s < real_logits.size(); ++s) {
    const torch::Tensor scale = 0.5 * (Distance(real_logits[s], true, kind) + Distance(fake_logits[s], false, kind));
    loss = s == 0 ? scale : loss + scale;
  }
  return loss;
}

torch::Tensor GeneratorLoss(const std::vector<torch::Tensor>& fake_logits, GanLossKind kind) {
  BODYLOOM_CHECK(!fake_logits.empty(), "generator loss: no logits");
  torch::Tensor loss;
  for (size_t s = 0; s < fake_logits.size(); ++s) {
    const torch::Tensor scale = Distance(fake_logits[s], true, kind);
    loss = s == 0 ? scale : loss + scale;
  }
  return loss;
}

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

LossBalance::LossBalance(int num_losses, int warmup)
    : num_losses_(num_losses), warmup_(warmup), state_(torch::zeros({2 + 2 * num_losses}, torch::kDouble)) {
  BODYLOOM_CHECK(num_losses >= 0 && warmup >= 1, "loss balance: ", num_losses, " losses, ", warmup,
                 " steps to warm up, expected 0 and 1 or more");
}

bool LossBalance::IsSet() const { return state_.data_ptr<double>()[0] >= warmup_; }

double LossBalance::Weight(int loss) const { return state_.data_ptr<double>()[2 + num_losses_ + loss]; }

void LossBalance::Measure(double reference, std::span<const double> losses) {
  BODYLOOM_CHECK(static_cast<int>(losses.size()) == num_losses_, "loss balance: ", losses.size(), " losses, expected ",
                 num_losses_);
  if (IsSet()) return;
  double* state = state_.data_ptr<double>();
  state[0] += 1;
  state[1] += reference;
  for (int i = 0; i < num_losses_; ++i) state[2 + i] += losses[i];
  if (!IsSet()) return;
  for (int i = 0; i < num_losses_; ++i) {
    const double sum = state[2 + i];
    state[2 + num_losses_ + i] = sum > 0 ? std::clamp(state[1] / sum, kMinimum, kMaximum) : 0;
  }
}

}  // namespace bodyloom
