// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/pose2sim_toml.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#define TOML_EXCEPTIONS 0
#define TOML_MAX_NESTED_VALUES 16
#include <toml++/toml.h>

#include "data_tools/formats/printable.h"

namespace bodyloom {
namespace {

/// Limit of the words of a key, each of which makes a nested table, which the parser frees by recursion.
constexpr std::ptrdiff_t kMaxDotsOfALine = 200;

/// JSON keys of this project by those of Pose2Sim; others are left out.
const std::map<std::string_view, const char*>& OwnKeys() {
  static const std::map<std::string_view, const char*> keys = {{"name", "name"},
                                                               {"matrix", "K"},
                                                               {"distortions", "distortion"},
                                                               {"rotation", "rotation"},
                                                               {"translation", "translation"}};
  return keys;
}

/// Dates and tables, which do not occur in cameras, become null.
nlohmann::json JsonOfToml(const toml::node& node) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* number = node.as_floating_point()) return number->get();
  if (const auto* integer = node.as_integer()) return integer->get();
  if (const auto* truth = node.as_boolean()) return truth->get();
  if (!node.is_array()) return nullptr;
  nlohmann::json values = nlohmann::json::array();
  for (const toml::node& item : *node.as_array()) values.push_back(JsonOfToml(item));
  return values;
}

using NamedToml = std::pair<std::string, const toml::table*>;

/// The tables that are cameras, in the order of the file.
std::vector<NamedToml> CameraTables(const toml::table& file) {
  static const std::set<std::string_view> others = {"cameras", "metadata", "capture_volume", "charuco", "checkerboard"};
  std::vector<NamedToml> cameras;
  for (const toml::table* tables : {&file, file["cameras"].as_table()}) {
    if (tables == nullptr) continue;
    for (const auto& [key, node] : *tables) {
      if (node.is_table() && others.count(key.str()) == 0) cameras.emplace_back(key.str(), node.as_table());
    }
  }
  std::sort(cameras.begin(), cameras.end(),
            [](const NamedToml& a, const NamedToml& b) { return a.second->source().begin < b.second->source().begin; });
  return cameras;
}

}  // namespace

nlohmann::json CamerasOfPose2SimToml(const std::string& text, const std::string& where) {
  std::vector<std::string_view> lines;
  for (size_t begin = 0, end = 0; begin <= text.size(); begin = end + 1) {
    end = std::min(text.find('\n', begin), text.size());
    lines.push_back(std::string_view(text).substr(begin, end - begin));
  }
  const auto fail = [&](size_t line, const std::string& expected) {
    const std::string found = PrintableText(lines[std::clamp<size_t>(line, 1, lines.size()) - 1]);
    throw std::runtime_error(where + ": line " + std::to_string(line) + ": '" + found + "', expected " + expected);
  };
  for (const std::string_view& line : lines) {
    if (std::count(line.begin(), line.end(), '.') > kMaxDotsOfALine) {
      fail(size_t(&line - lines.data()) + 1, "at most " + std::to_string(kMaxDotsOfALine) + " dots");
    }
  }
  const toml::parse_result file = toml::parse(std::string_view(text));
  if (!file) fail(file.error().source().begin.line, "TOML: " + PrintableText(file.error().description()));
  nlohmann::json cameras = nlohmann::json::array();
  for (const auto& [name, table] : CameraTables(file.table())) {
    nlohmann::json camera = {{"name", name}};
    for (const auto& [key, node] : *table) {
      if (const auto own = OwnKeys().find(key.str()); own != OwnKeys().end()) camera[own->second] = JsonOfToml(node);
    }
    if (const toml::node* size = table->get("size")) {
      const nlohmann::json sides = JsonOfToml(*size);
      if (!sides.is_array() || sides.size() != 2) fail(size->source().begin.line, "size = [width, height]");
      camera["width"] = sides[0], camera["height"] = sides[1];
    }
    cameras.push_back(std::move(camera));
  }
  if (cameras.empty()) throw std::runtime_error(where + ": no camera, expected a table with size and matrix");
  return cameras;
}

}  // namespace bodyloom
