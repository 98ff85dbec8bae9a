// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/landmark_names.h"

#include <algorithm>
#include <cctype>
#include <cstddef>

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

}  // namespace

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
