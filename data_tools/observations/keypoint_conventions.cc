// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/keypoint_conventions.h"

#include <algorithm>
#include <cctype>
#include <cstddef>

#include "geometry/base/check.h"
#include "geometry/scene/observations.h"

namespace bodyloom {
namespace {

/// "leftShoulder", "Left Shoulder", "LShoulder" → {"left"/"l", "shoulder"}: at separators and at capitals behind a
/// small letter, and behind a single L or R.
std::vector<std::string> WordsOf(std::string_view text) {
  const auto is = [&](size_t i, int (*kind)(int)) {
    return i < text.size() && kind(static_cast<unsigned char>(text[i])) != 0;
  };
  std::vector<std::string> words = {""};
  for (size_t i = 0; i < text.size(); ++i) {
    if (!is(i, std::isalnum)) {
      if (!words.back().empty()) words.emplace_back();
      continue;
    }
    const bool begins_side = i == 0 && (text[0] == 'L' || text[0] == 'R') && is(1, std::isupper) && is(2, std::islower);
    if (is(i, std::isupper) && i > 0 && is(i - 1, std::islower)) words.emplace_back();
    words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(text[i])));
    if (begins_side) words.emplace_back();
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

/// Moves "left", "l", "right" or "r" out of the words; "" if there is none.
std::string TakeSide(std::vector<std::string>* words) {
  const auto side_of = [](const std::string& word) {
    return word == "left" || word == "l" ? "left_" : word == "right" || word == "r" ? "right_" : "";
  };
  for (const size_t at : {size_t{0}, words->size() - 1}) {
    const std::string side = side_of((*words)[at]);
    if (side.empty() || words->size() < 2) continue;
    words->erase(words->begin() + std::ptrdiff_t(at));
    return side;
  }
  return "";
}

std::vector<std::string> CocoAnd(const std::vector<std::string>& more) {
  std::vector<std::string> names = CocoNames();
  names.insert(names.end(), more.begin(), more.end());
  return names;
}

}  // namespace

const KeypointConvention& Coco17() {
  static const KeypointConvention convention{"coco17", CocoNames()};
  return convention;
}

const KeypointConvention& Body25() {
  static const KeypointConvention convention{
      "body25", {"nose",           "neck",        "right_shoulder", "right_elbow",     "right_wrist",
                 "left_shoulder",  "left_elbow",  "left_wrist",     "mid_hip",         "right_hip",
                 "right_knee",     "right_ankle", "left_hip",       "left_knee",       "left_ankle",
                 "right_eye",      "left_eye",    "right_ear",      "left_ear",        "left_big_toe",
                 "left_small_toe", "left_heel",   "right_big_toe",  "right_small_toe", "right_heel"}};
  return convention;
}

const KeypointConvention& Body25B() {
  static const KeypointConvention convention{
      "body25b", CocoAnd({"upper_neck", "head_top", "left_big_toe", "left_small_toe", "left_heel", "right_big_toe",
                          "right_small_toe", "right_heel"})};
  return convention;
}

const KeypointConvention& OpenPoseCoco18() {
  static const KeypointConvention convention{
      "openpose_coco18",
      {"nose", "neck", "right_shoulder", "right_elbow", "right_wrist", "left_shoulder", "left_elbow", "left_wrist",
       "right_hip", "right_knee", "right_ankle", "left_hip", "left_knee", "left_ankle", "right_eye", "left_eye",
       "right_ear", "left_ear"}};
  return convention;
}

const KeypointConvention& CocoWholeBody23() {
  static const KeypointConvention convention{
      "coco_wholebody23",
      CocoAnd({"left_big_toe", "left_small_toe", "left_heel", "right_big_toe", "right_small_toe", "right_heel"})};
  return convention;
}

const KeypointConvention& Halpe26() {
  static const KeypointConvention convention{
      "halpe26", CocoAnd({"head_top", "neck", "mid_hip", "left_big_toe", "right_big_toe", "left_small_toe",
                          "right_small_toe", "left_heel", "right_heel"})};
  return convention;
}

const KeypointConvention& MediaPipe33() {
  static const KeypointConvention convention{
      "mediapipe33", {"nose",        "left_eye_inner",  "left_eye",       "left_eye_outer", "right_eye_inner",
                      "right_eye",   "right_eye_outer", "left_ear",       "right_ear",      "mouth_left",
                      "mouth_right", "left_shoulder",   "right_shoulder", "left_elbow",     "right_elbow",
                      "left_wrist",  "right_wrist",     "left_pinky",     "right_pinky",    "left_index",
                      "right_index", "left_thumb",      "right_thumb",    "left_hip",       "right_hip",
                      "left_knee",   "right_knee",      "left_ankle",     "right_ankle",    "left_heel",
                      "right_heel",  "left_big_toe",    "right_big_toe"}};
  return convention;
}

const KeypointConvention& Human36m17() {
  static const KeypointConvention convention{
      "human36m17",
      {"mid_hip", "right_hip", "right_knee", "right_ankle", "left_hip", "left_knee", "left_ankle", "spine", "neck",
       "head_front", "head_top", "left_shoulder", "left_elbow", "left_wrist", "right_shoulder", "right_elbow",
       "right_wrist"}};
  return convention;
}

const std::vector<const KeypointConvention*>& KnownConventions() {
  static const std::vector<const KeypointConvention*> conventions = {&Coco17(),         &Body25(),          &Body25B(),
                                                                     &OpenPoseCoco18(), &CocoWholeBody23(), &Halpe26(),
                                                                     &MediaPipe33(),    &Human36m17()};
  return conventions;
}

const KeypointConvention* ConventionOfCount(size_t num_points) {
  switch (num_points) {
    case 17:
      return &Coco17();
    case 23:
    case 133:
      return &CocoWholeBody23();
    case 26:
    case 136:
      return &Halpe26();
    default:
      return nullptr;
  }
}

void RequireConventionOfCount(size_t num_points, const std::string& place, const KeypointConvention** convention) {
  const KeypointConvention* found = ConventionOfCount(num_points);
  if (found == nullptr || (*convention != nullptr && found != *convention)) {
    ThrowFileError(place,
                   Concatenate(num_points, " landmarks, expected ",
                               *convention != nullptr ? "as many as before"
                                                      : "17 (COCO), 23 or 133 (COCO-WholeBody), 26 or 136 (Halpe)"));
  }
  *convention = found;
}

std::string LandmarkNameFrom(std::string_view text) {
  std::vector<std::string> words = WordsOf(text);
  if (words.empty()) return "";
  const std::string side = TakeSide(&words);
  std::string name;
  for (const std::string& word : words) name += (name.empty() ? "" : "_") + word;
  if (side.empty()) {
    if (name == "hip" || name == "hips" || name == "pelvis" || name == "midhip") return "mid_hip";
    if (name == "thorax") return "neck";
    return name;
  }
  if (name == "mouth") return side == "left_" ? "mouth_left" : "mouth_right";  // as MediaPipe spells them
  if (name == "foot_index" || name == "bigtoe") name = "big_toe";
  if (name == "smalltoe") name = "small_toe";
  return side + name;
}

KeypointConvention ConventionOfNames(const std::vector<std::string>& names) {
  for (const KeypointConvention* convention : KnownConventions()) {
    if (convention->names == names) return *convention;
  }
  const KeypointConvention* whole_body = ConventionOfCount(names.size());
  if (whole_body != nullptr && std::equal(whole_body->names.begin(), whole_body->names.end(), names.begin())) {
    return *whole_body;
  }
  return {"custom", names};
}

bool IsPersonLandmark(const std::string& name) {
  const std::vector<std::string>& names = Halpe26().names;
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace bodyloom
