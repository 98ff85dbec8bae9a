// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/report/saved_report.h"

#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

namespace bodyloom {
namespace {

using nlohmann::ordered_json;

double NumberOf(const ordered_json& json) {
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

void ReadRows(const ordered_json& group, BenchReport* report) {
  for (const ordered_json& line : group.at("rows")) {
    BenchRow row;
    row.group = group.at("name").get<std::string>();
    std::vector<std::string> labels, values;
    for (const auto& [key, value] : line.items()) {
      if (value.is_string()) {
        labels.push_back(key);
        row.labels.push_back(value.get<std::string>());
      } else {
        values.push_back(key);
        row.values.push_back(NumberOf(value));
      }
    }
    if (report->rows.empty()) {
      report->label_columns = labels;
      report->value_columns = values;
    }
    if (labels != report->label_columns || values != report->value_columns) {
      throw std::invalid_argument("rows with different columns");
    }
    report->rows.push_back(row);
  }
}

}  // namespace

SavedReport ReadSavedReport(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + ": cannot be opened, expected the JSON of a benchmark (--json)");
  try {
    const ordered_json json = ordered_json::parse(file);
    SavedReport saved;
    saved.report.title = json.at("title");
    saved.report.command = json.at("command");
    for (const char* name : {"commit", "processor", "cores", "compiler"}) saved.environment[name] = json.at(name);
    saved.report.notes = json.at("notes").get<std::vector<std::string>>();
    for (const ordered_json& group : json.at("groups")) ReadRows(group, &saved.report);
    return saved;
  } catch (const std::exception& error) {
    throw std::runtime_error(path + ": not the JSON of a benchmark: " + error.what());
  }
}

}  // namespace bodyloom
