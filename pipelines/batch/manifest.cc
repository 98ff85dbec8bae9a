// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/batch/manifest.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/formats/json_reader.h"
#include "bodyloom/data_tools/formats/printable.h"
#include "bodyloom/geometry/base/refuse.h"

namespace bodyloom {
namespace {

using nlohmann::json;

constexpr size_t kMostManifestBytes = size_t{256} << 20, kMostIdLength = 100;
constexpr JsonLimits kLineLimits = {.max_bytes = size_t{1} << 20, .max_depth = 2};

constexpr std::array kPathSettings = {"box-model",  "cameras",     "camera-path", "dense",    "detections",
                                      "init",       "body",        "lifter",      "models",   "prior",
                                      "pose-model", "part-labels", "video",       "reference"};
constexpr std::array kNotOfAClip = {"out", "json", "quiet", "plan", "no-overlay", "help"};

bool IsIn(const auto& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool IsPlainLetterOrDigit(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); }

bool IsClipId(const std::string& id) {
  return !id.empty() && id.size() <= kMostIdLength && IsPlainLetterOrDigit(id[0]) &&
         std::all_of(id.begin(), id.end(),
                     [](char c) { return IsPlainLetterOrDigit(c) || c == '.' || c == '_' || c == '-'; });
}

bool IsOptionName(const std::string& name) {
  return !name.empty() && name.front() != '-' && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
  });
}

std::string InLowerCase(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string SettingText(const json& value, const std::string& name, const std::string& place) {
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_number()) return value.dump();
  if (!value.is_string()) {
    Refuse(place, name, std::string("found ") + value.type_name() + ", expected a text, a number, true or false");
  }
  auto text = value.get<std::string>();
  if (text.empty() || !IsOneLine(text)) Refuse(place, name, "expected a text that is not empty, in one line");
  return text;
}

ManifestClip ClipFromLine(const std::string& line, const std::string& place, const std::filesystem::path& folder) {
  const json object = ParseJson(line, place, kLineLimits);
  if (!object.is_object()) Refuse(place, std::string("found ") + object.type_name() + ", expected a JSON object");
  ManifestClip clip;
  clip.place = place;
  for (const auto& [name, value] : object.items()) {
    if (!IsOptionName(name)) Refuse(place, "key '" + PrintableText(name) + "', expected the long name of an option");
    if (IsIn(kNotOfAClip, name)) Refuse(place, "'" + name + "' is no option of a clip of a batch: leave it out");
    const std::string text = SettingText(value, name, place);
    if (name == "id") {
      if (!value.is_string()) Refuse(place, name, "expected a text");
      clip.id = text;
    } else if (name == "verb") {
      clip.verb = text;
    } else {
      clip.settings[name] = IsPathSetting(name, text) && !text.starts_with('/') ? (folder / text).string() : text;
    }
  }
  if (!IsClipId(clip.id)) {
    Refuse(place, (clip.id.empty() ? "no 'id'" : "id '" + PrintableText(clip.id) + "'") +
                      ", expected 1 to 100 letters, digits, '.', '_' or '-', the first a letter or digit");
  }
  const auto given = [&](const char* name) { return clip.settings.contains(name); };
  const bool observed = given("detections") || given("dense") || given("part-labels");
  if (!observed && !given("video")) Refuse(place, "no input, expected 'video', 'detections', 'dense' or 'part-labels'");
  if (clip.verb.empty()) clip.verb = observed ? "track" : "run";
  if (clip.verb != "track" && clip.verb != "run") {
    Refuse(place, "verb '" + PrintableText(clip.verb) + "', expected track or run");
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
  std::map<std::string, size_t> line_of;  // of each id
  size_t number = 0;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    clips.push_back(ClipFromLine(line, path + ": line " + std::to_string(number), folder));
    const auto [other, is_new] = line_of.emplace(InLowerCase(clips.back().id), number);
    if (!is_new) {
      Refuse(clips.back().place, "id '" + clips.back().id + "' is that of line " + std::to_string(other->second) +
                                     ", expected another one");
    }
  }
  if (clips.empty()) Refuse(path, "no clips, expected one JSON object a line");
  return clips;
}

std::vector<ManifestClip> ReadManifest(const std::string& path) {
  return ManifestFromText(ReadFileBytes(path, kMostManifestBytes), path);
}

}  // namespace bodyloom
