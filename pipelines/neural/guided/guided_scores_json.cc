// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/guided/guided_scores_json.h"

#include <nlohmann/json.hpp>

namespace bodyloom {

nlohmann::ordered_json ToJson(const GuidedScores& s) {
  return {{"frames", s.frames},
          {"image_l1", s.image_l1},
          {"psnr_db", s.psnr_db},
          {"silhouette_iou", s.silhouette_iou},
          {"label_iou", s.label_iou},
          {"lpips_random_features", s.lpips},
          {"lpips_random_features_deviation", s.lpips_deviation},
          {"contextual_random_features", s.contextual}};
}

}  // namespace bodyloom
