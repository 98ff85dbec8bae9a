// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/motion/clip_scores.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "bodyloom/pipelines/neural/motion/clip_scores_json.h"
#include "bodyloom/pipelines/people/motion_errors_json.h"
#include "bodyloom/pipelines/people/planar_picture.h"

namespace bodyloom {
namespace {

constexpr int kSmallestForLpips = 32;  ///< pixels a side that LPIPS' network takes

}  // namespace

nlohmann::ordered_json ToJson(const ClipScores& scores) {
  const MotionScores& s = scores.windows;
  nlohmann::ordered_json json = {{"frames", s.frames},         {"image_l1", s.image_l1},
                                 {"psnr_db", s.psnr_db},       {"label_iou", s.label_iou},
                                 {"class_iou", s.class_iou},   {"foreground_iou", s.foreground_iou},
                                 {"normal_deg", s.normal_deg}, {"flicker", s.flicker}};
  if (!scores.by_similarity.empty()) json["by_similarity"] = ToJson(scores.by_similarity);
  if (scores.likeness) {
    json["lpips"] = scores.likeness->lpips;
    json["tlpips"] = scores.likeness->tlpips;
    json["lpips_of_random_features"] = scores.likeness->random_features;
  }
  if (scores.composed) {
    json["whole_picture_psnr_db"] = scores.composed->psnr_db;
    json["rim_psnr_db"] = scores.composed->rim_psnr_db;
  }
  return json;
}

ClipScorer::ClipScorer(std::vector<float> similarity, const PersonWindow& window, const std::string& set,
                       PictureSize picture)
    : errors_(std::move(similarity)) {
  if (std::min(window.width, window.height) >= kSmallestForLpips) likeness_ = std::make_unique<Likeness>();
  if (!set.empty()) composed_.emplace(set, picture.width, picture.height);
}

void ClipScorer::Restart() {
  if (likeness_) likeness_->temporal.Restart();
}

void ClipScorer::AddWindow(int t, const MotionPicture& picture, const MotionFrame& truth, double image_l1) {
  errors_.Add(t, image_l1);
  if (!likeness_) return;
  likeness_->temporal.Add(PictureOf(picture.image, picture.width, picture.height),
                          PictureOf(truth.image, truth.width, truth.height));
}

void ClipScorer::AddComposed(int t, const Image& composed) {
  if (composed_) composed_->Add(t, composed);
}

ClipScores ClipScorer::Scores(const MotionScores& windows) const {
  ClipScores scores;
  scores.windows = windows;
  scores.by_similarity = errors_.Quarters();
  if (likeness_) scores.likeness = likeness_->temporal.Mean();
  if (composed_) scores.composed = ClipScores::Composed{composed_->psnr_db(), composed_->rim_psnr_db()};
  return scores;
}

}  // namespace bodyloom
