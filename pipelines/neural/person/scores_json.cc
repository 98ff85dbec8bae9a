// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/person/scores_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace bodyloom {

nlohmann::ordered_json ToJson(const PersonScores& s) {
  nlohmann::ordered_json json = {
      {"frames", s.frames}, {"image_l1", s.image_l1}, {"psnr_db", s.psnr_db}, {"silhouette_iou", s.silhouette_iou}};
  if (!std::isnan(s.label_iou)) json["label_iou"] = s.label_iou;
  json[LpipsName("lpips", s.lpips_random_features)] = s.lpips;
  json[LpipsName("lpips_deviation", s.lpips_random_features)] = s.lpips_deviation;
  if (!std::isnan(s.contextual)) {
    json[s.contextual_random_features ? "contextual_quarter_random_features" : "contextual_vgg19"] = s.contextual;
  }
  json[LpipsName("lpips_of_people", s.lpips_random_features)] = s.lpips_of_people;
  return json;
}

}  // namespace bodyloom
