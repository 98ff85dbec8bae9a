// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/formats/printable.h"

#include <algorithm>

namespace bodyloom {
namespace {

constexpr size_t kMaxLength = 80, kMaxNames = 20;

}  // namespace

std::string PrintableText(std::string_view text) {
  std::string printable(text.substr(0, kMaxLength));
  for (char& c : printable) {
    if (c < 32 || c > 126) c = '?';
  }
  return printable + (text.size() > kMaxLength ? "..." : "");
}

std::string PrintableList(const std::vector<std::string>& names) {
  if (names.empty()) return "nothing";
  std::string list;
  for (size_t i = 0; i < std::min(names.size(), kMaxNames); ++i) list += (i == 0 ? "" : ", ") + PrintableText(names[i]);
  if (names.size() > kMaxNames) list += " and " + std::to_string(names.size() - kMaxNames) + " more";
  return list;
}

bool IsOneLine(std::string_view text) {
  return std::none_of(text.begin(), text.end(), [](char c) { return (c >= 0 && c < 32) || c == 127; });
}

}  // namespace bodyloom
