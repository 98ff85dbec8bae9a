// SPDX-License-Identifier: Apache-2.0
#include "neural/losses/image_losses.h"

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

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

}  // namespace bodyloom
