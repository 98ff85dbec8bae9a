// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/refiner/refiner_module.h"

namespace bodyloom {
namespace {

using torch::Tensor;

/// Whether there is one of `inside` up to `reach` pixels away along x and y, as numbers.
Tensor Near(const Tensor& inside, int64_t reach) {
  const int64_t window = 2 * reach + 1;
  return torch::max_pool2d(inside.to(torch::kFloat), {window, window}, {1, 1}, {reach, reach});
}

}  // namespace

RefinerModuleImpl::RefinerModuleImpl(bool moves_outline)
    : moves_outline(moves_outline), network(register_module("network", PictureUnetModule(kRefinerPlanes))) {}

Tensor RefinerModuleImpl::forward(const Tensor& planes) {
  const Tensor change = network(planes);
  const Tensor alpha = planes.narrow(1, PersonPlane::kAlpha, 1), of_alpha = change.narrow(1, PersonPlane::kAlpha, 1);
  const Tensor of_colour = change.narrow(1, 0, PersonPlane::kAlpha);
  if (!moves_outline) return torch::cat({of_colour, torch::zeros_like(of_alpha)}, 1);
  // At 0, where training begins, both sides must let gradients through.
  const Tensor kept = of_alpha * torch::where(of_alpha > 0, Near(alpha > 0, OutlineReach::kOutwards),
                                              Near(alpha < 0.5, OutlineReach::kInwards));
  return torch::cat({of_colour, kept}, 1);
}

Tensor ChangedPerson(const Tensor& planes, const Tensor& change) {
  return torch::clamp(planes.narrow(1, 0, 4) + torch::tanh(change), 0, 1);
}

}  // namespace bodyloom
