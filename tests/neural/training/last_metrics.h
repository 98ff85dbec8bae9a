// SPDX-License-Identifier: Apache-2.0
/// Reads the last values of a run's metrics.csv.
#pragma once

#include <map>
#include <sstream>
#include <string>

#include "tests/support/test_files.h"

namespace bodyloom {

/// Last value by column; columns without a value are left out.
inline std::map<std::string, double> LastMetrics(const std::string& run_dir) {
  std::istringstream lines(FileBytes(run_dir + "/metrics.csv"));
  std::string names, row, name, value;
  std::getline(lines, names);
  for (std::string line; std::getline(lines, line);) row = line;
  std::map<std::string, double> metrics;
  std::istringstream of_names(names), of_row(row);
  while (std::getline(of_names, name, ',') && std::getline(of_row, value, ',')) {
    if (!value.empty()) metrics[name] = std::stod(value);
  }
  return metrics;
}

}  // namespace bodyloom
