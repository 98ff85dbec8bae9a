// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/guided/guided_scores_json.h"

#include <nlohmann/json.hpp>

#include "bodyloom/neural/metrics/lpips.h"

namespace bodyloom {

nlohmann::ordered_json ToJson(const GuidedScores& s) {
  return {{"frames", s.frames},
          {"image_l1", s.image_l1},
          {"psnr_db", s.psnr_db},
          {"silhouette_iou", s.silhouette_iou},
          {"label_iou", s.label_iou},
          {LpipsName("lpips", s.lpips_random_features), s.lpips},
          {LpipsName("lpips_deviation", s.lpips_random_features), s.lpips_deviation},
          {s.contextual_random_features ? "contextual_quarter_random_features" : "contextual_vgg19", s.contextual}};
}

}  // namespace bodyloom
