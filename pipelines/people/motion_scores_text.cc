// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/people/motion_scores_text.h"

#include <cmath>
#include <cstdio>

namespace bodyloom {
namespace {

/// "name value, name value, …", without values that are NaN.
class ScoreLine {
 public:
  void Add(const std::string& name, int digits, double value, const char* unit = "") {
    if (std::isnan(value)) return;
    char number[32];
    std::snprintf(number, sizeof number, " %.*f", digits, value);
    text_ += (text_.empty() ? "" : ", ") + name + number + unit;
  }
  void AddLikeness(double ssim, double lpips, double tlpips, bool random_features) {
    Add("SSIM", 4, ssim);
    const char* network = random_features ? " (random features)" : "";
    Add(std::string("LPIPS") + network, 4, lpips);
    Add(std::string("tLPIPS") + network, 5, tlpips);
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace

std::string ScoresText(const MotionScores& scores) {
  ScoreLine line;
  line.Add("L1", 4, scores.image_l1);
  line.Add("PSNR", 2, scores.psnr_db, " dB");
  line.AddLikeness(scores.ssim, scores.lpips, scores.tlpips, scores.lpips_random_features);
  line.Add("labels IoU", 3, scores.label_iou);
  line.Add("silhouette IoU", 3, scores.foreground_iou);
  line.Add("normals", 1, scores.normal_deg, " deg");
  line.Add("flicker", 4, scores.flicker);
  return line.text();
}

std::string ScoresText(const MotionFrameScores& scores, bool lpips_random_features) {
  ScoreLine line;
  line.Add("L1", 4, scores.image_l1);
  line.AddLikeness(scores.ssim, scores.lpips, scores.tlpips, lpips_random_features);
  return line.text();
}

}  // namespace bodyloom
