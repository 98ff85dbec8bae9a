// SPDX-License-Identifier: Apache-2.0
/// Scores of the pose-guided renderer in a report.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <utility>

#include "neural/guided/guided_scores.h"
#include "pipelines/neural/weights_folder.h"

namespace bodyloom {

/// One object; what features measured is named for it.
nlohmann::ordered_json ToJson(const GuidedScores& scores);

/// A folder's alexnet, lpips_alex and vgg19.
inline GuidedScoreWeights GuidedScoreWeightsOf(WeightsFolder weights) {
  return {std::move(weights.alexnet), std::move(weights.lpips_heads), std::move(weights.vgg19)};
}

}  // namespace bodyloom
