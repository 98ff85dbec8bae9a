// SPDX-License-Identifier: Apache-2.0
/// Reads a benchmark's JSON (accuracy/bench_report.h).
#pragma once

#include <map>
#include <string>

#include "benchmarks/accuracy/bench_report.h"

namespace bodyloom {

struct SavedReport {
  BenchReport report;                              ///< label columns: those whose values are texts; no plots
  std::map<std::string, std::string> environment;  ///< commit, processor, cores, compiler
};

/// Reads the file. Throws std::runtime_error naming the file and the missing part when it is not a benchmark's JSON.
SavedReport ReadSavedReport(const std::string& path);

}  // namespace bodyloom
