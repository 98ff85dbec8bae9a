// SPDX-License-Identifier: Apache-2.0
#include "neural/motion/motion_scorer.h"

#include <cmath>
#include <limits>

namespace bodyloom {

using torch::Tensor;

void MotionScorer::Add(const MotionState& predicted, const MotionTruth& truth, int before_x, int before_y) {
  const Tensor& mask = truth.foreground;
  const Tensor error = predicted.image - truth.image;
  const double l1 = (mask * error).abs().sum().item<double>() / 3, foreground = mask.sum().item<double>();
  l1_ += l1;
  last_l1_ = foreground > 0 ? l1 / foreground : std::numeric_limits<double>::quiet_NaN();
  squared_ += (mask * error).square().sum().item<double>() / 3;
  foreground_ += foreground;
  if (last_error_.defined()) {
    const Tensor change = error - Shifted(last_error_, before_x, before_y);
    flicker_ += (mask * change).abs().sum().item<double>() / 3;
    foreground_with_past_ += foreground;
  }
  last_error_ = error;
  if (predicted.labels.defined() && truth.labels.defined()) {
    const Tensor said = predicted.labels.argmax(1), is = truth.labels.argmax(1);
    both_.resize(config_.num_labels, 0);
    either_.resize(config_.num_labels, 0);
    for (int k = 0; k < config_.num_labels; ++k) {
      both_[k] += (said.eq(k) & is.eq(k)).sum().item<double>();
      either_[k] += (said.eq(k) | is.eq(k)).sum().item<double>();
    }
    foreground_both_ += (said.gt(0) & is.gt(0)).sum().item<double>();
    foreground_either_ += (said.gt(0) | is.gt(0)).sum().item<double>();
  }
  if (predicted.normals.defined() && truth.normals.defined()) {
    const Tensor norms = (predicted.normals.norm(2, 1) * truth.normals.norm(2, 1)).clamp_min(1e-9);
    const Tensor cosine = ((predicted.normals * truth.normals).sum(1) / norms).clamp(-1, 1);
    const Tensor known = mask.squeeze(1) * truth.normals.norm(2, 1).gt(0.5).to(torch::kFloat);
    angle_deg_ += (torch::acos(cosine) * known).sum().item<double>() * 180 / M_PI;
    foreground_with_normals_ += known.sum().item<double>();
  }
  ++frames_;
}

MotionScores MotionScorer::Scores() const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto mean = [](double sum, double count) { return count > 0 ? sum / count : kNone; };
  MotionScores scores;
  scores.frames = frames_;
  scores.image_l1 = mean(l1_, foreground_);
  scores.psnr_db = -10 * std::log10(mean(squared_, foreground_));
  scores.flicker = mean(flicker_, foreground_with_past_);
  scores.normal_deg = mean(angle_deg_, foreground_with_normals_);
  scores.foreground_iou = mean(foreground_both_, foreground_either_);
  double sum = 0;
  int classes = 0;
  for (size_t k = 0; k < either_.size(); ++k) {
    scores.class_iou.push_back(mean(both_[k], either_[k]));
    if (k == 0 || either_[k] == 0) continue;
    sum += both_[k] / either_[k];
    ++classes;
  }
  scores.label_iou = mean(sum, classes);
  return scores;
}

}  // namespace bodyloom
