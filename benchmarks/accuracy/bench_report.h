// SPDX-License-Identifier: Apache-2.0
/// Report of a benchmark: rows of labels and numbers, their mean and spread by group, commit and machine.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace bodyloom {

struct BenchRow {
  std::string group;                ///< rows of one group are averaged ("known focal length")
  std::vector<std::string> labels;  ///< one per label column
  std::vector<double> values;       ///< one per value column; NaN prints as "-"
};

struct PlotLine {
  std::string name;
  std::vector<std::pair<double, double>> points;
  bool dashed = false;  ///< a limit, drawn without marks
  bool stairs = false;  ///< constant between points
};

struct Plot {
  std::string file;  ///< name without extension
  std::string title, x_label, y_label;
  bool log_x = true, log_y = true;
  std::vector<PlotLine> lines;
};

struct BenchReport {
  std::string title;
  std::string command;                     ///< as it was called
  std::vector<std::string> label_columns;  ///< "clip", "camera"
  std::vector<std::string> value_columns;  ///< "pa_mpjpe_mm", …
  std::vector<BenchRow> rows;
  std::vector<std::string> notes;
  std::vector<Plot> plots;  ///< drawn by benchmarks/report/draw_plots.py
  bool summarise = true;    ///< close each group with the mean and spread of its rows
};

/// One table per group, ending with "mean" and "std" (population, over its rows) if requested, then notes, commit and
/// machine.
std::string BenchText(const BenchReport& report);

/// {title, command, commit, machine, notes, groups: [{name, rows: [{label: …, value: …}], mean: {…}, std: {…}}],
/// plots: [{file, title, x_label, y_label, log_x, log_y, lines: [{name, dashed, stairs, points: [[x, y], …]}]}]}.
/// benchmarks/report/saved_report.h reads it, all but the plots.
std::string BenchJson(const BenchReport& report);

/// Prints the text and, when `json_path` is not empty, writes the JSON.
void HandOver(const BenchReport& report, const std::string& json_path);

/// Commit of the source tree ("… with changes" when it has any), processor, cores, compiler and flags.
std::vector<std::pair<std::string, std::string>> BenchEnvironment();

/// Formats a number for the tables: integers unchanged, else three decimals below ten and one above; tiny numbers as
/// 2e-07; "-" for NaN.
std::string BenchNumber(double value);

}  // namespace bodyloom
