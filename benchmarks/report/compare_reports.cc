// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/report/compare_reports.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

const std::string kSpread = "_spread_percent";

std::string Joined(const std::vector<std::string>& labels) {
  std::string text;
  for (const std::string& label : labels) text += (text.empty() ? "" : ", ") + label;
  return text;
}

const BenchRow* Partner(const BenchReport& report, const BenchRow& row) {
  const auto found = std::find_if(report.rows.begin(), report.rows.end(), [&](const BenchRow& other) {
    return other.group == row.group && other.labels == row.labels;
  });
  return found == report.rows.end() ? nullptr : &*found;
}

double ValueOf(const BenchReport& report, const BenchRow& row, const std::string& column) {
  const auto found = std::find(report.value_columns.begin(), report.value_columns.end(), column);
  return found == report.value_columns.end() ? std::numeric_limits<double>::quiet_NaN()
                                             : row.values[found - report.value_columns.begin()];
}

ComparedColumn Mean(const std::vector<ComparedValue>& values, const std::string& group, const std::string& column) {
  ComparedColumn mean{group, column};
  double sum = 0, squares = 0;
  for (const ComparedValue& value : values) {
    if (value.group != group || value.column != column) continue;
    ++mean.rows;
    sum += std::log(value.ratio);
    squares += std::log(value.ratio) * std::log(value.ratio);
  }
  mean.ratio = std::exp(sum / mean.rows);
  const double variance = squares / mean.rows - (sum / mean.rows) * (sum / mean.rows);
  mean.spread_percent = 100 * std::expm1(std::sqrt(std::max(0.0, variance)));
  return mean;
}

std::string Percent(double value) {
  if (!std::isfinite(value)) return "";
  char text[32];
  std::snprintf(text, sizeof text, "± %.1f %%", value);
  return text;
}

}  // namespace

bool ComparedValue::Stands() const {
  return std::isfinite(spread_percent) && std::abs(std::log(ratio)) > 2 * std::log1p(spread_percent / 100);
}

Comparison CompareReports(const SavedReport& before, const SavedReport& after) {
  Comparison result;
  for (const char* what : {"processor", "cores", "compiler"}) {
    const std::string &a = before.environment.at(what), &b = after.environment.at(what);
    if (a != b) result.warnings.push_back(Concatenate("not the same ", what, ": ", a, " and ", b));
  }
  for (const BenchRow& row : after.report.rows) result.only_after += Partner(before.report, row) == nullptr;
  for (const BenchRow& row : before.report.rows) {
    const BenchRow* partner = Partner(after.report, row);
    if (partner == nullptr) {
      ++result.only_before;
      continue;
    }
    for (const std::string& column : before.report.value_columns) {
      if (column.ends_with(kSpread)) continue;
      ComparedValue value{row.group, Joined(row.labels), column, ValueOf(before.report, row, column),
                          ValueOf(after.report, *partner, column)};
      if (!(value.before > 0) || !(value.after > 0)) continue;
      value.ratio = value.after / value.before;
      value.spread_percent =
          std::hypot(ValueOf(before.report, row, column + kSpread), ValueOf(after.report, *partner, column + kSpread));
      result.values.push_back(value);
    }
  }
  for (const ComparedValue& value : result.values) {
    const bool known = std::any_of(result.columns.begin(), result.columns.end(), [&](const ComparedColumn& column) {
      return column.group == value.group && column.column == value.column;
    });
    if (!known) result.columns.push_back(Mean(result.values, value.group, value.column));
  }
  return result;
}

std::string ComparisonText(const SavedReport& before, const SavedReport& after, const Comparison& comparison) {
  std::string text =
      Concatenate(after.report.title, "\n  before: ", before.environment.at("commit"), ", ", before.report.command,
                  "\n  after:  ", after.environment.at("commit"), ", ", after.report.command, "\n");
  for (const std::string& warning : comparison.warnings) text += "  warning: " + warning + "\n";
  std::string group;
  char line[320];
  for (const ComparedValue& value : comparison.values) {
    if (value.group != group) text += "\n" + (group = value.group) + "\n";
    std::snprintf(line, sizeof line, "  %-44s %-22s %12s → %-12s × %.3f %s%s\n", value.labels.c_str(),
                  value.column.c_str(), BenchNumber(value.before).c_str(), BenchNumber(value.after).c_str(),
                  value.ratio, Percent(value.spread_percent).c_str(), value.Stands() ? " *" : "");
    text += line;
  }
  text += "\ngeometric means, ± standard deviation over the rows\n";
  for (const ComparedColumn& column : comparison.columns) {
    std::snprintf(line, sizeof line, "  %-44s %-14s %3d rows × %.3f %s\n", column.group.c_str(), column.column.c_str(),
                  column.rows, column.ratio, Percent(column.spread_percent).c_str());
    text += line;
  }
  if (comparison.only_before + comparison.only_after > 0) {
    text +=
        Concatenate("rows without a partner: ", comparison.only_before, " before, ", comparison.only_after, " after\n");
  }
  return text + "(ratio = after / before; ± is both runs' own spread; * lies outside twice of it)\n";
}

}  // namespace bodyloom
