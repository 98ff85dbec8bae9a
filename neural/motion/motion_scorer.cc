// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/motion/motion_scorer.h"

#include <cmath>
#include <limits>

#include "bodyloom/neural/device.h"

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
    if (overlap_.num_classes() == 0) overlap_ = ClassOverlap(config_.num_labels);
    overlap_.Add(HostValues<uint8_t>(predicted.labels.argmax(1)), HostValues<uint8_t>(truth.labels.argmax(1)));
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
  scores.foreground_iou = overlap_.ForegroundIou();
  for (int k = 0; k < overlap_.num_classes(); ++k) scores.class_iou.push_back(overlap_.Iou(k));
  scores.label_iou = overlap_.MeanIou(/*in_truth=*/false);
  return scores;
}

}  // namespace bodyloom
