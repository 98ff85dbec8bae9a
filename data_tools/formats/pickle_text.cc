// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/pickle_machine.h"

#include <algorithm>
#include <charconv>
#include <cstdint>

#include "data_tools/formats/printable.h"

namespace bodyloom {
namespace {

/// The number that exactly n digits stand for.
std::optional<uint32_t> Digits(std::string_view text, size_t n, int base) {
  uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (text.size() != n || error != std::errc() || end != text.data() + n) return std::nullopt;
  return value;
}

}  // namespace

std::optional<std::string> UnquotePython2(std::string_view line) {
  if (line.size() < 2 || line.front() != line.back() || (line.front() != '\'' && line.front() != '"')) {
    return std::nullopt;
  }
  line = line.substr(1, line.size() - 2);
  static constexpr std::string_view kFrom = "\\'\"abfnrtv", kTo = "\\'\"\a\b\f\n\r\t\v";
  std::string text;
  for (size_t i = 0; i < line.size(); ++i) {
    if (line[i] != '\\') {
      text.push_back(line[i]);
      continue;
    }
    if (++i >= line.size()) return std::nullopt;
    const size_t known = kFrom.find(line[i]);
    if (known != std::string_view::npos) {
      text.push_back(kTo[known]);
      continue;
    }
    const bool hex = line[i] == 'x';
    size_t n = hex ? 2 : 0;
    if (hex) {
      ++i;
    } else {
      while (n < 3 && i + n < line.size() && line[i + n] >= '0' && line[i + n] <= '7') ++n;
    }
    const std::optional<uint32_t> code = Digits(line.substr(i, n), std::max<size_t>(n, 1), hex ? 16 : 8);
    if (!code) return std::nullopt;
    text.push_back(static_cast<char>(*code));
    i += n - 1;
  }
  return text;
}

std::optional<std::string> DecodeRawUnicode(std::string_view line) {
  std::string text;
  for (size_t i = 0; i < line.size(); ++i) {
    const bool escape = line[i] == '\\' && i + 1 < line.size() && (line[i + 1] == 'u' || line[i + 1] == 'U');
    if (!escape) {
      AppendUtf8(static_cast<unsigned char>(line[i]), &text);
      continue;
    }
    const size_t n = line[i + 1] == 'u' ? 4 : 8;
    const std::optional<uint32_t> code = Digits(line.substr(i + 2, n), n, 16);
    if (!code) return std::nullopt;
    AppendUtf8(*code, &text);
    i += 1 + n;
  }
  return text;
}

}  // namespace bodyloom
