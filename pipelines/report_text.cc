// SPDX-License-Identifier: Apache-2.0
#include "pipelines/report_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace bodyloom {
namespace {

void Append(const std::string& item, std::string* list) { *list += (list->empty() ? "" : ", ") + item; }

}  // namespace

std::string CountsText(const std::map<std::string, int>& counts) {
  std::string text;
  for (const auto& [name, count] : counts) {
    if (count > 0) Append(std::to_string(count) + " " + name, &text);
  }
  return text;
}

std::string StagesText(const StageSeconds& stages) {
  std::string text;
  for (const auto& [stage, seconds] : stages) Append(stage + " " + Fixed(seconds, 2), &text);
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
