// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "bodyloom/neural/guided/guided_scores.h"
#include "bodyloom/pipelines/neural/weights_folder.h"

namespace bodyloom {

/// Of a folder's alexnet, lpips_alex and vgg19. Empty and throws as ReadWeightsFolder.
inline GuidedScoreWeights ReadGuidedScoreWeights(const std::string& folder) {
  WeightsFolder weights = ReadWeightsFolder(folder);
  return {std::move(weights.alexnet), std::move(weights.lpips_heads), std::move(weights.vgg19)};
}

}  // namespace bodyloom
