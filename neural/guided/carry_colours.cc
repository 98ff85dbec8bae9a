// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/guided/carry_colours.h"

#include "bodyloom/neural/networks/pull_push.h"
#include "bodyloom/neural/people/photo_frame.h"

namespace bodyloom {

using torch::Tensor;

namespace {

constexpr int kLevels = 5;  ///< outwards by some 32 pixels

}  // namespace

Tensor CarryColours(const Tensor& image, const Tensor& known, const Tensor& known_classes, const Tensor& classes) {
  const torch::NoGradGuard no_grad;
  Tensor result = PullPush(image, known, kLevels);
  if (!classes.defined()) return result;
  for (int k = 1; k < kPhotoLabels; ++k) {
    const Tensor here = classes == k;
    const Tensor mask = known * (known_classes == k);
    const Tensor somewhere = mask.amax({1, 2, 3}, /*keepdim=*/true) > 0;
    const Tensor takes = here & somewhere;
    if (!takes.any().item<bool>()) continue;
    result = torch::where(takes, PullPush(image, mask, kLevels), result);
  }
  return result;
}

}  // namespace bodyloom
