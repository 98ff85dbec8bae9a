// SPDX-License-Identifier: Apache-2.0
#include "pipelines/batch/manifest.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "data_tools/formats/json_reader.h"
#include "data_tools/formats/printable.h"
#include "geometry/base/callbacks.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using nlohmann::json;

constexpr const char* kIdCharacters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-";

constexpr std::array kPathSettings = {"box-model",  "cameras",     "camera-path", "dense",    "detections",
                                      "init",       "body",        "lifter",      "models",   "prior",
                                      "pose-model", "part-labels", "video",       "reference"};
constexpr std::array kNotOfAClip = {"out", "json", "quiet", "plan", "no-overlay", "help"};

bool IsIn(const auto& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool IsClipId(const std::string& id) {
  return !id.empty() && id.size() <= 100 && id.find_first_not_of(kIdCharacters) == std::string::npos &&
         id.find_first_of("._-") != 0;
}

std::string SettingText(const json& value, const std::string& name, const std::string& place) {
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_number()) return value.dump();
  if (!value.is_string()) {
    ThrowFileError(place, name,
                   std::string("found ") + value.type_name() + ", expected a text, a number, true or false");
  }
  auto text = value.get<std::string>();
  if (text.empty() || !IsOneLine(text)) ThrowFileError(place, name, "expected a text that is not empty, in one line");
  return text;
}

ManifestClip ClipFromLine(const std::string& line, const std::string& place, const std::filesystem::path& folder) {
  const json object = ParseJson(line, place, {.max_bytes = size_t{1} << 20, .max_depth = 2});
  if (!object.is_object())
    ThrowFileError(place, std::string("found ") + object.type_name() + ", expected a JSON object");
  ManifestClip clip;
  clip.place = place;
  for (const auto& [name, value] : object.items()) {
    if (IsIn(kNotOfAClip, name))
      ThrowFileError(place, "'" + name + "' is no option of a clip of a batch: leave it out");
    const std::string text = SettingText(value, PrintableText(name), place);
    if (name == "id") {
      if (!value.is_string()) ThrowFileError(place, name, "expected a text");
      clip.id = text;
    } else if (name == "verb") {
      clip.verb = text;
    } else {
      clip.settings[name] = IsPathSetting(name, text) && !text.starts_with('/') ? (folder / text).string() : text;
    }
  }
  if (!IsClipId(clip.id)) {
    ThrowFileError(place, (clip.id.empty() ? "no 'id'" : "id '" + PrintableText(clip.id) + "'") +
                              ", expected 1 to 100 letters, digits, '.', '_' or '-', the first a letter or digit");
  }
  const auto given = [&](const char* name) { return clip.settings.contains(name); };
  const bool observed = given("detections") || given("dense") || given("part-labels");
  if (!observed && !given("video"))
    ThrowFileError(place, "no input, expected 'video', 'detections', 'dense' or 'part-labels'");
  if (clip.verb.empty()) clip.verb = observed ? "track" : "run";
  if (clip.verb != "track" && clip.verb != "run") {
    ThrowFileError(place, "verb '" + PrintableText(clip.verb) + "', expected track or run");
  }
  return clip;
}

}  // namespace

bool IsPathSetting(const std::string& name, const std::string& value) {
  return IsIn(kPathSettings, name) && !((name == "prior" || name == "lifter") && value == "none");
}

std::vector<ManifestClip> ManifestFromText(const std::string& text, const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::vector<ManifestClip> clips;
  std::map<std::string, size_t> line_of;  // of each id in lower case
  std::istringstream stream(text);
  std::string line;
  for (size_t number = 1; std::getline(stream, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    clips.push_back(ClipFromLine(line, path + ": line " + std::to_string(number), folder));
    std::string id = clips.back().id;
    for (char& c : id) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const auto [other, is_new] = line_of.emplace(id, number);
    if (!is_new) {
      ThrowFileError(clips.back().place, "id '" + clips.back().id + "' is that of line " +
                                             std::to_string(other->second) + ", expected another one");
    }
  }
  if (clips.empty()) ThrowFileError(path, "no clips, expected one JSON object a line");
  return clips;
}

std::vector<ManifestClip> ShardOf(const std::vector<ManifestClip>& clips, const std::string& text) {
  size_t index = 0, count = 0;
  const char* const end = text.data() + text.size();
  const auto [slash, error] = std::from_chars(text.data(), end, index);
  const bool both = error == std::errc() && slash != end && *slash == '/';
  const auto [rest, other_error] = both ? std::from_chars(slash + 1, end, count) : std::from_chars_result{};
  if (!both || other_error != std::errc() || rest != end || index >= count) {
    throw RequestError("--shard '" + PrintableText(text) + "', expected i/N with i from 0 to N - 1, as in 0/6 to 5/6");
  }
  std::vector<ManifestClip> own;
  for (size_t k = index; k < clips.size(); k += count) own.push_back(clips[k]);
  return own;
}

}  // namespace bodyloom
