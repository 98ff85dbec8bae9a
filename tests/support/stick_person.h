// SPDX-License-Identifier: Apache-2.0
/// A standing person in an image, by landmark name, for tests of detection readers.
#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace bodyloom {

/// Pixel of a landmark of a person of `height_px` who faces the camera, the middle of the hips at (x, y). The person's
/// left is on the right of the image.
inline std::pair<double, double> StickLandmark(const std::string& name, double x, double y, double height_px) {
  static const std::map<std::string, std::pair<double, double>> middle = {{"nose", {0, -.38}},
                                                                          {"neck", {0, -.29}},
                                                                          {"upper_neck", {0, -.30}},
                                                                          {"head_top", {0, -.46}},
                                                                          {"mid_hip", {0, 0}}};
  static const std::map<std::string, std::pair<double, double>> side = {
      {"eye", {.02, -.40}},    {"ear", {.04, -.39}},      {"shoulder", {.10, -.29}}, {"elbow", {.13, -.13}},
      {"wrist", {.15, .02}},   {"hip", {.055, 0}},        {"knee", {.06, .24}},      {"ankle", {.06, .46}},
      {"big_toe", {.06, .51}}, {"small_toe", {.10, .50}}, {"heel", {.06, .48}}};
  if (const auto found = middle.find(name); found != middle.end()) {
    return {x + found->second.first * height_px, y + found->second.second * height_px};
  }
  const bool is_left = name.rfind("left_", 0) == 0;
  const auto found = side.find(name.substr(is_left ? 5 : 6));
  if (found == side.end()) throw std::invalid_argument("no stick landmark " + name);
  return {x + (is_left ? 1 : -1) * found->second.first * height_px, y + found->second.second * height_px};
}

/// "x,y,c,x,y,c,…" of those landmarks.
inline std::string StickNumbers(const std::vector<std::string>& names, double x, double y, double height_px,
                                double confidence = 0.9) {
  std::string text;
  for (const std::string& name : names) {
    const auto [px, py] = StickLandmark(name, x, y, height_px);
    text +=
        (text.empty() ? "" : ",") + std::to_string(px) + "," + std::to_string(py) + "," + std::to_string(confidence);
  }
  return text;
}

}  // namespace bodyloom
