// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/evaluation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "geometry/base/check.h"
#include "geometry/base/percentile.h"

namespace bodyloom {
namespace {

constexpr size_t kWidth = 100;

/// Characters on a terminal: bytes that do not continue a UTF-8 sequence.
size_t DisplayWidth(const std::string& text) {
  return static_cast<size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string Padded(const std::string& text, size_t width) {
  const size_t own = DisplayWidth(text);
  return text + std::string(width > own ? width - own : 0, ' ');
}

std::string Number(double value) {
  if (!std::isfinite(value)) return "-";
  char text[32];
  constexpr double kShown = 0.0005;
  std::snprintf(text, sizeof(text), "%.3f", std::abs(value) < kShown ? 0.0 : value);  // without the sign of zero
  return text;
}

/// `text` broken into lines at spaces, each after `indent` spaces.
std::string Wrapped(const std::string& text, size_t indent) {
  std::string result, line;
  const auto flush = [&] {
    if (!line.empty()) result += std::string(indent, ' ') + line + "\n";
    line.clear();
  };
  size_t begin = 0;
  while (begin < text.size()) {
    const size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    if (DisplayWidth(line) + DisplayWidth(word) + 1 + indent > kWidth) flush();
    line += (line.empty() ? "" : " ") + word;
    begin = end + 1;
  }
  flush();
  return result;
}

}  // namespace

double Evaluation::Value(const std::string& name) const {
  for (const EvaluationValue& entry : values) {
    if (entry.name == name) return entry.value;
  }
  BODYLOOM_CHECK(false, "the evaluation '", protocol, "' has no value '", name, "'");
  return 0;
}

std::string EvaluationTable(const Evaluation& evaluation) {
  std::string text = "protocol " + evaluation.protocol + "\n" + Wrapped(evaluation.description, 2);
  for (const auto& [key, value] : evaluation.subject) text += "  " + key + ": " + value + "\n";
  text += "  frames: " + std::to_string(evaluation.frames) +
          ", without a result: " + std::to_string(evaluation.frames_without_result) + "\n";
  size_t name_width = 0, number_width = 0;
  for (const EvaluationValue& entry : evaluation.values) {
    name_width = std::max(name_width, DisplayWidth(entry.name));
    number_width = std::max(number_width, Number(entry.value).size());
  }
  for (const EvaluationValue& entry : evaluation.values) {
    const std::string number = Number(entry.value);
    text += "  " + Padded(entry.name, name_width) + "  " + std::string(number_width - number.size(), ' ') + number +
            "  " + entry.meaning + "\n";
  }
  for (const EvaluationBreakdown& breakdown : evaluation.breakdowns) {
    std::string line;
    for (size_t i = 0; i < breakdown.labels.size(); ++i) {
      line += (i > 0 ? ", " : "") + breakdown.labels[i] + " " + Number(breakdown.values[i]);
    }
    text += "  " + breakdown.name + ":\n" + Wrapped(line, 4);
  }
  return text;
}

std::string EvaluationJson(const Evaluation& evaluation) {
  nlohmann::ordered_json json;
  json["protocol"] = evaluation.protocol;
  json["description"] = evaluation.description;
  json["subject"] = nlohmann::ordered_json::object();
  for (const auto& [key, value] : evaluation.subject) json["subject"][key] = value;
  json["frames"] = evaluation.frames;
  json["frames_without_result"] = evaluation.frames_without_result;
  json["values"] = nlohmann::ordered_json::object();
  json["meanings"] = nlohmann::ordered_json::object();
  for (const EvaluationValue& entry : evaluation.values) {
    json["values"][entry.name] = entry.value;
    json["meanings"][entry.name] = entry.meaning;
  }
  json["breakdowns"] = nlohmann::ordered_json::object();
  for (const EvaluationBreakdown& breakdown : evaluation.breakdowns) {
    nlohmann::ordered_json& target = json["breakdowns"][breakdown.name];
    target = nlohmann::ordered_json::object();
    for (size_t i = 0; i < breakdown.labels.size(); ++i) target[breakdown.labels[i]] = breakdown.values[i];
  }
  // NaN becomes null. A subject may hold any bytes of a file name: what is not UTF-8 is replaced rather than refused.
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

double MedianKneeFlexionDeg(const Motion& motion) {
  constexpr int kLeftKnee = 4, kRightKnee = 5;
  std::vector<double> flexion_deg;
  for (int t = 0; t < motion.num_frames(); ++t) {
    if (motion.poses.cols() < 3 * (kRightKnee + 1) || !motion.poses.row(t).allFinite()) continue;
    for (const int knee : {kLeftKnee, kRightKnee}) flexion_deg.push_back(motion.poses(t, 3 * knee) * 180 / M_PI);
  }
  return Percentile(flexion_deg, 50);
}

void AddKneeFlexion(const Motion& estimate, const Motion* truth, Evaluation* evaluation) {
  evaluation->Add("knee_flexion_deg", MedianKneeFlexionDeg(estimate),
                  "how bent the knees are, median over frames and both (0: straight)");
  if (truth != nullptr) evaluation->Add("gt_knee_flexion_deg", MedianKneeFlexionDeg(*truth), "of the truth");
}

Evaluation EvaluateAlone(const Track& track) {
  Evaluation result;
  result.protocol = "track-alone";
  result.description = "Nothing to compare with: what the track says of itself. Frames without a result are left out.";
  result.frames = track.num_frames();
  for (int t = 0; t < track.num_frames(); ++t) result.frames_without_result += track.HasResult(t) ? 0 : 1;
  AddKneeFlexion(track.motion, nullptr, &result);
  return result;
}

}  // namespace bodyloom
