// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "bodyloom/neural/guided/guided_scores.h"
#include "bodyloom/pipelines/neural/weights_folder.h"

namespace bodyloom {

/// A folder's alexnet, lpips_alex and vgg19.
inline GuidedScoreWeights GuidedScoreWeightsOf(WeightsFolder weights) {
  return {std::move(weights.alexnet), std::move(weights.lpips_heads), std::move(weights.vgg19)};
}

}  // namespace bodyloom
