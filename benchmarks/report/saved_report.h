// SPDX-License-Identifier: Apache-2.0
/// A benchmark's JSON (accuracy/bench_report.h), read back.
#pragma once

#include <map>
#include <string>

#include "benchmarks/accuracy/bench_report.h"

namespace bodyloom {

struct SavedReport {
  BenchReport report;                              ///< label columns: those whose values are texts; no plots
  std::map<std::string, std::string> environment;  ///< commit, processor, cores, compiler
};

/// Throws std::runtime_error naming the file, and what is not there, when it is no benchmark's JSON.
SavedReport ReadSavedReport(const std::string& path);

}  // namespace bodyloom
