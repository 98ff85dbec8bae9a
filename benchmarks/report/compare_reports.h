// SPDX-License-Identifier: Apache-2.0
/// Compares two runs of one benchmark at two commits by the ratios of time, memory and error.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/report/saved_report.h"

namespace bodyloom {

/// Comparison of one number of one row.
struct ComparedValue {
  std::string group, labels, column;
  double before = 0, after = 0;
  double ratio = 1;                   ///< after / before
  double spread_percent = 0;          ///< of the ratio: root sum of squares of both runs' spreads; NaN: not measured
  [[nodiscard]] bool Stands() const;  ///< the spread is known and the change exceeds twice its size
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

/// Matches rows by group and labels. Values are compared if both are positive; columns that end in "_spread_percent"
/// give the spread of "<name>" and are not compared themselves.
Comparison CompareReports(const SavedReport& before, const SavedReport& after);

/// One table per group and the geometric means; `*` marks ratios with Stands().
std::string ComparisonText(const SavedReport& before, const SavedReport& after, const Comparison& comparison);

}  // namespace bodyloom
