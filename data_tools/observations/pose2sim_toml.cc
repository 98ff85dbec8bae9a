// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/pose2sim_toml.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "data_tools/formats/printable.h"

namespace bodyloom {
namespace {

std::string TomlTrimmed(const std::string& text) {
  const size_t begin = text.find_first_not_of(" \t\r"), end = text.find_last_not_of(" \t\r");
  return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

/// Our JSON's keys by Pose2Sim's.
const std::map<std::string, std::string>& OwnKeys() {
  static const std::map<std::string, std::string> keys = {
      {"matrix", "K"}, {"distortions", "distortion"}, {"rotation", "rotation"}, {"translation", "translation"}};
  return keys;
}

}  // namespace

nlohmann::json CamerasOfPose2SimToml(const std::string& text, const std::string& where) {
  static const std::set<std::string> others = {"metadata", "capture_volume", "charuco", "checkerboard"};
  nlohmann::json cameras = nlohmann::json::array();
  bool is_camera = false;
  std::istringstream stream(text);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    const int first = number;
    const auto fail = [&](const std::string& expected) {
      throw std::runtime_error(where + ": line " + std::to_string(first) + ": '" + PrintableText(line) +
                               "', expected " + expected);
    };
    line = TomlTrimmed(line.substr(0, line.find('#')));
    if (line.empty()) continue;
    if (line.front() == '[' && line.find('=') == std::string::npos) {
      if (line.back() != ']' || line.size() < 3) fail("a table in brackets");
      std::string name = TomlTrimmed(line.substr(1, line.size() - 2));
      if (name.starts_with("cameras.")) name = name.substr(8);
      is_camera = others.count(name) == 0;
      if (is_camera) cameras.push_back({{"name", name}});
      continue;
    }
    const size_t equal = line.find('=');
    if (equal == std::string::npos) fail("key = value");
    const std::string key = TomlTrimmed(line.substr(0, equal));
    std::string value = TomlTrimmed(line.substr(equal + 1)), more;
    while (std::count(value.begin(), value.end(), '[') > std::count(value.begin(), value.end(), ']') &&
           std::getline(stream, more)) {
      ++number;
      value += " " + TomlTrimmed(more.substr(0, more.find('#')));
    }
    if (!is_camera || (key != "name" && key != "size" && OwnKeys().count(key) == 0)) continue;
    const nlohmann::json parsed = nlohmann::json::parse(value, nullptr, false);
    if (parsed.is_discarded()) fail("a number, a text or an array of them");
    nlohmann::json& camera = cameras.back();
    if (key == "name") {
      if (!parsed.is_string()) fail("the camera's name");
      camera["name"] = parsed;
    } else if (key == "size") {
      if (!parsed.is_array() || parsed.size() != 2 || !parsed[0].is_number() || !parsed[1].is_number() ||
          !(parsed[0].get<double>() >= 1 && parsed[0].get<double>() < 1e6) ||
          !(parsed[1].get<double>() >= 1 && parsed[1].get<double>() < 1e6)) {
        fail("size = [width, height]");
      }
      camera["width"] = static_cast<int>(parsed[0].get<double>());
      camera["height"] = static_cast<int>(parsed[1].get<double>());
    } else {
      camera[OwnKeys().at(key)] = parsed;
    }
  }
  if (cameras.empty()) throw std::runtime_error(where + ": no camera, expected a table with size and matrix");
  return cameras;
}

}  // namespace bodyloom
