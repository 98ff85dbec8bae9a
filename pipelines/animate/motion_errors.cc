// SPDX-License-Identifier: Apache-2.0
#include "pipelines/animate/motion_errors.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "data_tools/formats/atomic_file.h"

namespace bodyloom {
namespace {

constexpr std::pair<const char*, double MotionFrameScores::*> kColumns[] = {{"image_l1", &MotionFrameScores::image_l1},
                                                                            {"ssim", &MotionFrameScores::ssim},
                                                                            {"lpips", &MotionFrameScores::lpips},
                                                                            {"tlpips", &MotionFrameScores::tlpips}};

}  // namespace

void MotionErrors::Add(int frame, const MotionFrameScores& scores) {
  errors_.push_back(
      {frame, scores, similarity_.empty() ? std::numeric_limits<float>::quiet_NaN() : similarity_.at(frame)});
}

void MotionErrors::WriteCsv(const std::string& path) const {
  std::ostringstream text;
  text << "frame";
  for (const auto& [name, value] : kColumns) text << ',' << name;
  text << ",similarity\n";
  const auto add = [&](double value) {
    text << ',';
    if (!std::isnan(value)) text << value;
  };
  for (const Error& error : errors_) {
    text << error.frame;
    for (const auto& [name, value] : kColumns) add(error.scores.*value);
    add(error.similarity);
    text << '\n';
  }
  WriteFileAtomically(path, text.str());
}

std::vector<MotionErrors::Quarter> MotionErrors::Quarters() const {
  std::vector<Error> sorted;
  std::copy_if(errors_.begin(), errors_.end(), std::back_inserter(sorted),
               [](const Error& e) { return std::isfinite(e.similarity) && std::isfinite(e.scores.image_l1); });
  if (sorted.size() < 4) return {};
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Error& a, const Error& b) { return a.similarity < b.similarity; });
  std::vector<Quarter> quarters(4);
  for (size_t q = 0; q < 4; ++q) {
    const size_t begin = q * sorted.size() / 4, end = (q + 1) * sorted.size() / 4;
    quarters[q].min_similarity = sorted[begin].similarity;
    quarters[q].frames = static_cast<int>(end - begin);
    for (const auto& [name, value] : kColumns) {
      double sum = 0;
      int count = 0;
      for (size_t i = begin; i < end; ++i) {
        if (std::isnan(sorted[i].scores.*value)) continue;
        sum += sorted[i].scores.*value;
        ++count;
      }
      if (count > 0) quarters[q].scores.*value = sum / count;
    }
  }
  return quarters;
}

nlohmann::ordered_json ToJson(const std::vector<MotionErrors::Quarter>& quarters) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const MotionErrors::Quarter& quarter : quarters) {
    nlohmann::ordered_json row = {{"min_similarity", quarter.min_similarity}};
    for (const auto& [name, value] : kColumns) row[name] = quarter.scores.*value;
    row["frames"] = quarter.frames;
    json.push_back(row);
  }
  return json;
}

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
