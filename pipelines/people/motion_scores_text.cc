// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/people/motion_scores_text.h"

#include <cmath>
#include <cstdio>

namespace bodyloom {

std::string ScoresText(const MotionScores& scores) {
  std::string text;
  const auto add = [&](const char* name, int digits, double value, const char* unit) {
    if (std::isnan(value)) return;
    char part[64];
    std::snprintf(part, sizeof part, "%s%s %.*f%s", text.empty() ? "" : ", ", name, digits, value, unit);
    text += part;
  };
  add("L1", 4, scores.image_l1, "");
  add("PSNR", 2, scores.psnr_db, " dB");
  add("labels IoU", 3, scores.label_iou, "");
  add("silhouette IoU", 3, scores.foreground_iou, "");
  add("normals", 1, scores.normal_deg, " deg");
  add("flicker", 4, scores.flicker, "");
  return text;
}

}  // namespace bodyloom
