// SPDX-License-Identifier: Apache-2.0
/// Two runs of one benchmark, of two commits: how many times as much time, memory and error the second one takes.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/report/saved_report.h"

namespace bodyloom {

/// One number of one row.
struct ComparedValue {
  std::string group, labels, column;
  double before = 0, after = 0;
  double ratio = 1;           ///< after / before
  double spread_percent = 0;  ///< of the ratio: root sum of squares of both runs' own spreads; NaN: not measured
  [[nodiscard]] bool Stands() const;  ///< known spread, and the ratio lies outside twice of it
};

/// Geometric mean of a column's ratios over the rows of a group.
struct ComparedColumn {
  std::string group, column;
  int rows = 0;
  double ratio = 1;
  double spread_percent = 0;  ///< standard deviation of the rows' ratios about it
};

struct Comparison {
  std::vector<ComparedValue> values;
  std::vector<ComparedColumn> columns;
  int only_before = 0, only_after = 0;  ///< rows without a partner
  std::vector<std::string> warnings;    ///< another machine, another command
};

/// Rows are partners when group and labels are equal. Values are compared when both are positive; columns that end in
/// "_spread_percent" give the spread of "<name>" and are not compared themselves.
Comparison CompareReports(const SavedReport& before, const SavedReport& after);

/// A table a group and the geometric means; `*` marks ratios that stand.
std::string ComparisonText(const SavedReport& before, const SavedReport& after, const Comparison& comparison);

}  // namespace bodyloom
