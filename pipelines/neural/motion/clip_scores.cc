// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/motion/clip_scores.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "pipelines/animate/motion_errors.h"
#include "pipelines/neural/weights_folder.h"

namespace bodyloom {
nlohmann::ordered_json ToJson(const ClipScores& scores) {
  const MotionScores& s = scores.windows;
  nlohmann::ordered_json json = {{"frames", s.frames},
                                 {"image_l1", s.image_l1},
                                 {"psnr_db", s.psnr_db},
                                 {"label_iou", s.label_iou},
                                 {"class_iou", s.class_iou},
                                 {"foreground_iou", s.foreground_iou},
                                 {"normal_deg", s.normal_deg},
                                 {"flicker", s.flicker},
                                 {"ssim", s.ssim},
                                 {"ssim_preset", ToText(kWindowSsim)},
                                 {"lpips", s.lpips},
                                 {"tlpips", s.tlpips},
                                 {"lpips_of_random_features", s.lpips_random_features}};
  if (!scores.by_similarity.empty()) json["by_similarity"] = ToJson(scores.by_similarity);
  if (scores.composed) {
    json["whole_picture_psnr_db"] = scores.composed->psnr_db;
    json["rim_psnr_db"] = scores.composed->rim_psnr_db;
  }
  return json;
}

ClipScorer::ClipScorer(std::vector<float> similarity, const std::string& set, ImageSize image)
    : errors_(std::move(similarity)) {
  if (!set.empty()) composed_.emplace(set, image.width, image.height);
}

void ClipScorer::AddComposed(int t, const Image& composed) {
  if (composed_) composed_->Add(t, composed);
}

ClipScores ClipScorer::Scores(const MotionScores& windows) const {
  ClipScores scores;
  scores.windows = windows;
  scores.by_similarity = errors_.Quarters();
  if (composed_) scores.composed = ClipScores::Composed{composed_->psnr_db(), composed_->rim_psnr_db()};
  return scores;
}

}  // namespace bodyloom
