// SPDX-License-Identifier: Apache-2.0
#include "neural/losses/gan_losses.h"

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

/// Loss of logits with the label "real" (or "fake").
torch::Tensor Distance(const torch::Tensor& logits, bool real, GanLossKind kind) {
  if (kind == GanLossKind::kLeastSquares) return (real ? logits - 1 : logits).square().mean();
  return torch::softplus(real ? -logits : logits).mean();
}

}  // namespace

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

}  // namespace bodyloom
