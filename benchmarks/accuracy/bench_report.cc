// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/accuracy/bench_report.h"

#include <stdio.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "data_tools/evaluation/metrics.h"
#include "data_tools/formats/atomic_file.h"
#include "geometry/base/check.h"
#include "tests/support/paths.h"

namespace bodyloom {
namespace {

std::string FirstLineOf(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen((command + " 2>/dev/null").c_str(), "r"), pclose);
  char line[256] = "";
  if (!pipe || fgets(line, sizeof(line), pipe.get()) == nullptr) return "";
  std::string text = line;
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

std::string Processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

std::vector<std::string> Groups(const BenchReport& report) {
  std::vector<std::string> groups;
  for (const BenchRow& row : report.rows) {
    if (std::find(groups.begin(), groups.end(), row.group) == groups.end()) groups.push_back(row.group);
  }
  return groups;
}

ErrorStatistics Column(const BenchReport& report, const std::string& group, size_t column) {
  std::vector<double> values;
  for (const BenchRow& row : report.rows) {
    if (row.group == group) values.push_back(row.values[column]);
  }
  return Summarize(values);
}

/// A column's name over several lines, broken at underscores: "pa_mpjpe_mm" gives "pa", "mpjpe", "mm".
std::vector<std::string> Stacked(const std::string& name) {
  std::vector<std::string> lines(1);
  for (char c : name) {
    if (c == '_') {
      lines.emplace_back();
    } else {
      lines.back() += c;
    }
  }
  return lines;
}

void CheckRows(const BenchReport& report) {
  for (const BenchRow& row : report.rows) {
    BODYLOOM_CHECK(row.labels.size() == report.label_columns.size() && row.values.size() == report.value_columns.size(),
                   "benchmark row has ", row.labels.size(), " labels and ", row.values.size(), " values, expected ",
                   report.label_columns.size(), " and ", report.value_columns.size());
  }
}

}  // namespace

std::string BenchNumber(double value) {
  if (!std::isfinite(value)) return "-";
  const double size = std::abs(value);
  const bool whole = value == std::floor(value) && size < 1e9;
  char text[32];
  snprintf(text, sizeof(text), whole ? "%.0f" : size < 5e-4 ? "%.0e" : size < 10 ? "%.3f" : "%.1f", value);
  return text;
}

std::vector<std::pair<std::string, std::string>> BenchEnvironment() {
  const std::string git = "git -C '" + SourceDir() + "' ";
  std::string commit = FirstLineOf(git + "rev-parse --short=12 HEAD");
  if (commit.empty()) commit = "unknown";
  if (!FirstLineOf(git + "status --porcelain --untracked-files=no").empty()) commit += " with changes";
  return {{"commit", commit},
          {"processor", Processor()},
          {"cores", std::to_string(std::thread::hardware_concurrency())},
          {"compiler", "g++ " __VERSION__ ", " BODYLOOM_BUILD_TYPE}};
}

std::string BenchText(const BenchReport& report) {
  CheckRows(report);
  std::string text = report.title + "\n";
  for (const std::string& group : Groups(report)) {
    std::vector<std::vector<std::string>> cells;
    std::vector<std::string> head = report.label_columns;
    head.insert(head.end(), report.value_columns.begin(), report.value_columns.end());
    size_t head_lines = 1;
    for (const std::string& name : head) head_lines = std::max(head_lines, Stacked(name).size());
    cells.assign(head_lines, std::vector<std::string>(head.size()));
    for (size_t c = 0; c < head.size(); ++c) {
      const std::vector<std::string> lines = Stacked(head[c]);
      for (size_t i = 0; i < lines.size(); ++i) cells[head_lines - lines.size() + i][c] = lines[i];
    }
    int rows = 0;
    for (const BenchRow& row : report.rows) {
      if (row.group != group) continue;
      std::vector<std::string> line = row.labels;
      for (double value : row.values) line.push_back(BenchNumber(value));
      cells.push_back(line);
      ++rows;
    }
    if (rows > 1 && report.summarise) {
      std::vector<std::string> mean(report.label_columns.size()), spread(report.label_columns.size());
      mean[0] = "mean";
      spread[0] = "std";
      for (size_t c = 0; c < report.value_columns.size(); ++c) {
        const ErrorStatistics s = Column(report, group, c);
        mean.push_back(BenchNumber(s.mean));
        spread.push_back(BenchNumber(s.std_dev));
      }
      cells.push_back(mean);
      cells.push_back(spread);
    }
    std::vector<size_t> widths(head.size(), 0);
    for (const auto& line : cells) {
      for (size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], line[c].size());
    }
    text += "\n" + group + "\n";
    for (const auto& line : cells) {
      for (size_t c = 0; c < line.size(); ++c) {
        const std::string space(widths[c] - line[c].size(), ' ');
        text += "  " + (c < report.label_columns.size() ? line[c] + space : space + line[c]);
      }
      text += "\n";
    }
  }
  text += "\n";
  for (const std::string& note : report.notes) text += "  " + note + "\n";
  text += "  command: " + report.command + "\n";
  for (const auto& [name, value] : BenchEnvironment()) text += "  " + name + ": " + value + "\n";
  return text;
}

std::string BenchJson(const BenchReport& report) {
  CheckRows(report);
  nlohmann::ordered_json json;
  json["title"] = report.title;
  json["command"] = report.command;
  for (const auto& [name, value] : BenchEnvironment()) json[name] = value;
  json["notes"] = report.notes;
  json["groups"] = nlohmann::ordered_json::array();
  for (const std::string& group : Groups(report)) {
    nlohmann::ordered_json entry;
    entry["name"] = group;
    for (const BenchRow& row : report.rows) {
      if (row.group != group) continue;
      nlohmann::ordered_json line;
      for (size_t c = 0; c < row.labels.size(); ++c) line[report.label_columns[c]] = row.labels[c];
      for (size_t c = 0; c < row.values.size(); ++c) line[report.value_columns[c]] = row.values[c];
      entry["rows"].push_back(line);
    }
    for (size_t c = 0; c < report.value_columns.size() && report.summarise; ++c) {
      const ErrorStatistics s = Column(report, group, c);
      entry["mean"][report.value_columns[c]] = s.mean;
      entry["std"][report.value_columns[c]] = s.std_dev;
    }
    json["groups"].push_back(entry);
  }
  for (const Plot& plot : report.plots) {
    nlohmann::ordered_json drawn = {{"file", plot.file},       {"title", plot.title}, {"x_label", plot.x_label},
                                    {"y_label", plot.y_label}, {"log_x", plot.log_x}, {"log_y", plot.log_y}};
    drawn["lines"] = nlohmann::ordered_json::array();
    for (const PlotLine& line : plot.lines) {
      drawn["lines"].push_back(
          {{"name", line.name}, {"dashed", line.dashed}, {"stairs", line.stairs}, {"points", line.points}});
    }
    json["plots"].push_back(drawn);
  }
  return json.dump(2) + "\n";
}

void HandOver(const BenchReport& report, const std::string& json_path) {
  std::fputs(BenchText(report).c_str(), stdout);
  if (!json_path.empty()) WriteFileAtomically(json_path, BenchJson(report));
}

}  // namespace bodyloom
