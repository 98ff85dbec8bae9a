// SPDX-License-Identifier: Apache-2.0
#include "neural/motion/motion_scorer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "neural/base/device.h"
#include "neural/base/image_tensor.h"

namespace bodyloom {

using torch::Tensor;

MotionScorer::MotionScorer(const MotionConfig& config, const WindowScoring& windows)
    : config_(config), windows_(windows) {
  if (windows_.lpips) temporal_.emplace(*windows_.lpips);
}

void MotionScorer::Restart() {
  last_error_ = Tensor();
  if (temporal_) temporal_->Restart();
}

void MotionScorer::CompareWindows(const Tensor& predicted, const Tensor& truth, int before_x, int before_y) {
  if (std::min(truth.size(2), truth.size(3)) < WindowScoring::kSmallestSide || !(temporal_ || windows_.ssim)) return;
  const Image result = ToImage(predicted), expected = ToImage(truth);
  if (windows_.ssim) last_.ssim = windows_.ssim(expected, result), ssim_ += last_.ssim;
  if (temporal_) {
    const TemporalLpips::Frame frame = temporal_->Add(result, expected, before_x, before_y);
    last_.lpips = frame.lpips;
    if (frame.tlpips) last_.tlpips = *frame.tlpips;
  }
  ++windows_compared_;
}

void MotionScorer::Add(const MotionState& predicted, const MotionTruth& truth, int before_x, int before_y) {
  const Tensor& mask = truth.foreground;
  const Tensor error = predicted.image - truth.image;
  const double l1 = (mask * error).abs().sum().item<double>() / 3, foreground = mask.sum().item<double>();
  l1_ += l1;
  last_ = {};
  if (foreground > 0) last_.image_l1 = l1 / foreground;
  CompareWindows(predicted.image, truth.image, before_x, before_y);
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
  scores.ssim = mean(ssim_, windows_.ssim ? windows_compared_ : 0);
  scores.lpips = scores.tlpips = kNone;
  if (temporal_ && windows_compared_ > 0) {
    const TemporalLpipsMean likeness = temporal_->Mean();
    scores.lpips = likeness.lpips;
    scores.lpips_random_features = likeness.random_features;
    if (likeness.pairs > 0) scores.tlpips = likeness.tlpips;
  }
  return scores;
}

}  // namespace bodyloom
