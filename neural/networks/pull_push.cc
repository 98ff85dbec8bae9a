// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/networks/pull_push.h"

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

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
  // Nothing known: 0/1 instead of 0/0.
  const Tensor coarse = torch::avg_pool2d(known, 2) / (share + (1 - coarse_mask));
  const Tensor filled = PullPush(coarse, coarse_mask, levels - 1);
  return known + (1 - mask) * torch::upsample_bilinear2d(filled, {height, width}, /*align_corners=*/false);
}

}  // namespace bodyloom
