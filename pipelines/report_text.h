// SPDX-License-Identifier: Apache-2.0
/// Numbers as text for people.
#pragma once

#include <cstdio>
#include <map>
#include <string>

#include "geometry/base/stopwatch.h"

namespace bodyloom {

/// With so many digits after the point: Fixed(1.25, 1) is "1.2".
inline std::string Fixed(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

// Lists of a report in one line: "5 lost, 8 tracked", "read 0.43, detect 63.70".

/// "count name, count name", without those that count 0; empty when none is left.
std::string CountsText(const std::map<std::string, int>& counts);

/// "stage seconds, stage seconds", two digits after the point.
std::string StagesText(const StageSeconds& stages);

// Times as text for people.

/// "0:07", "12:34", "1:02:03"; rounded to seconds, 0 for negative ones.
std::string ClockText(double seconds);

}  // namespace bodyloom
