// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/list_text.h"

#include "bodyloom/pipelines/fixed_text.h"

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

}  // namespace bodyloom
