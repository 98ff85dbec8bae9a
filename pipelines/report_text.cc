// SPDX-License-Identifier: Apache-2.0
#include "pipelines/report_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace bodyloom {
std::string StagesText(const StageSeconds& stages) {
  std::string text;
  for (const auto& [stage, seconds] : stages) text += (text.empty() ? "" : ", ") + stage + " " + Fixed(seconds, 2);
  return text;
}

std::string ClockText(double seconds) {
  const auto whole = static_cast<long long>(std::max(0.0, std::round(seconds)));
  char text[48];
  if (whole >= 3600) {
    std::snprintf(text, sizeof text, "%lld:%02lld:%02lld", whole / 3600, whole / 60 % 60, whole % 60);
  } else {
    std::snprintf(text, sizeof text, "%lld:%02lld", whole / 60, whole % 60);
  }
  return text;
}

}  // namespace bodyloom
