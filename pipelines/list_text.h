// SPDX-License-Identifier: Apache-2.0
/// Lists of a report in one line: "5 lost, 8 tracked", "read 0.43, detect 63.70".
#pragma once

#include <map>
#include <string>

#include "bodyloom/geometry/base/stopwatch.h"

namespace bodyloom {

/// "count name, count name", without those that count 0; empty when none is left.
std::string CountsText(const std::map<std::string, int>& counts);

/// "stage seconds, stage seconds", two digits after the point.
std::string StagesText(const StageSeconds& stages);

}  // namespace bodyloom
