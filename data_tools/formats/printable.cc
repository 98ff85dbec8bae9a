// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/printable.h"

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

void AppendUtf8(uint32_t code, std::string* text) {
  if (code > 0x10FFFF || (code >= 0xD800 && code < 0xE000)) code = 0xFFFD;  // not a character
  if (code < 0x80) {
    text->push_back(static_cast<char>(code));
  } else if (code < 0x800) {
    text->push_back(static_cast<char>(0xC0 | (code >> 6)));
    text->push_back(static_cast<char>(0x80 | (code & 63)));
  } else if (code < 0x10000) {
    text->push_back(static_cast<char>(0xE0 | (code >> 12)));
    text->push_back(static_cast<char>(0x80 | ((code >> 6) & 63)));
    text->push_back(static_cast<char>(0x80 | (code & 63)));
  } else {
    text->push_back(static_cast<char>(0xF0 | (code >> 18)));
    text->push_back(static_cast<char>(0x80 | ((code >> 12) & 63)));
    text->push_back(static_cast<char>(0x80 | ((code >> 6) & 63)));
    text->push_back(static_cast<char>(0x80 | (code & 63)));
  }
}

std::vector<uint32_t> CodePoints(std::string_view text) {
  std::vector<uint32_t> codes;
  for (size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const size_t length = byte < 0x80 ? 1 : byte >= 0xF0 ? 4 : byte >= 0xE0 ? 3 : byte >= 0xC0 ? 2 : 1;
    if (length == 1 || i + length > text.size()) {
      codes.push_back(byte);
      ++i;
      continue;
    }
    uint32_t code = byte & (0xFFU >> (length + 1));
    for (size_t k = 1; k < length; ++k) code = (code << 6) | (static_cast<unsigned char>(text[i + k]) & 63U);
    codes.push_back(code);
    i += length;
  }
  return codes;
}

}  // namespace bodyloom
