// SPDX-License-Identifier: Apache-2.0
/// Formatting of numbers, lists and times for reports.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "geometry/base/stopwatch.h"

namespace bodyloom {

/// Formats with a fixed number of decimals: Fixed(1.25, 1) is "1.2".
inline std::string Fixed(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

/// "left, right"
inline std::string Joined(const std::vector<std::string>& words, const std::string& separator = ", ") {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

/// "read 0.43, detect 63.70": seconds by stage with two decimals.
std::string StagesText(const StageSeconds& stages);

/// "0:07", "12:34", "1:02:03": rounded to seconds; 0 for negative times.
std::string ClockText(double seconds);

}  // namespace bodyloom
