// SPDX-License-Identifier: Apache-2.0
#include "neural/networks/uv_sampler.h"

#include "geometry/base/check.h"

namespace bodyloom {

torch::Tensor SampleUv(const torch::Tensor& features, const torch::Tensor& uv, const torch::Tensor& mask) {
  BODYLOOM_CHECK(features.dim() == 4 && uv.dim() == 4 && mask.dim() == 4, "UV sampler: tensors of ", features.dim(),
                 ", ", uv.dim(), " and ", mask.dim(), " dimensions, expected 4 each");
  const int64_t B = features.size(0), h = uv.size(2), w = uv.size(3);
  BODYLOOM_CHECK(uv.sizes() == torch::IntArrayRef({B, 2, h, w}) && mask.sizes() == torch::IntArrayRef({B, 1, h, w}),
                 "UV sampler: uv of shape ", uv.sizes(), " and mask of shape ", mask.sizes(), ", expected ", B,
                 " x 2 x h x w and ", B, " x 1 x h x w");
  BODYLOOM_CHECK(features.scalar_type() == uv.scalar_type() && mask.scalar_type() == uv.scalar_type() &&
                     features.device() == uv.device() && mask.device() == uv.device(),
                 "UV sampler: features, uv and mask are of different types or on different devices");
  // grid_sample's coordinates without aligned corners: −1 and 1 are the map's outer edges, y downwards.
  const torch::Tensor sign = torch::tensor({2.0, -2.0}, uv.options()).view({1, 2, 1, 1});
  const torch::Tensor offset = torch::tensor({-1.0, 1.0}, uv.options()).view({1, 2, 1, 1});
  const torch::Tensor on_body = mask != 0;
  const torch::Tensor grid = torch::where(on_body, sign * uv + offset, torch::zeros({}, uv.options()));
  namespace F = torch::nn::functional;
  const torch::Tensor sampled = F::grid_sample(
      features, grid.permute({0, 2, 3, 1}),
      F::GridSampleFuncOptions().mode(torch::kBilinear).padding_mode(torch::kBorder).align_corners(false));
  return sampled * mask;
}

using torch::Tensor;

Tensor PullPush(const Tensor& x, const Tensor& mask, int levels) {
  BODYLOOM_CHECK(x.dim() == 4 && mask.dim() == 4 && mask.size(0) == x.size(0) && mask.size(1) == 1 &&
                     mask.size(2) == x.size(2) && mask.size(3) == x.size(3),
                 "pull-push: an image of shape ", x.sizes(), " with a mask of shape ", mask.sizes());
  Tensor known = x * mask;
  const int64_t height = x.size(2), width = x.size(3);
  if (levels <= 0 || height % 2 != 0 || width % 2 != 0) return known;
  const Tensor share = torch::avg_pool2d(mask, 2);
  const Tensor coarse_mask = (share > 0).to(mask.scalar_type());
  // Without known pixels: 0/1 instead of 0/0.
  const Tensor coarse = torch::avg_pool2d(known, 2) / (share + (1 - coarse_mask));
  const Tensor filled = PullPush(coarse, coarse_mask, levels - 1);
  return known + (1 - mask) * torch::upsample_bilinear2d(filled, {height, width}, /*align_corners=*/false);
}

}  // namespace bodyloom
