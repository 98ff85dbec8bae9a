// SPDX-License-Identifier: Apache-2.0
/// Makes text from files safe for messages: one line of bounded length without control characters.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace bodyloom {

/// At most 80 characters; everything but printable ASCII becomes '?'.
std::string PrintableText(std::string_view text);

/// "a, b, c": the first twenty names, then the number of further ones; "nothing" for none.
std::string PrintableList(const std::vector<std::string>& names);

/// False when the text holds ASCII control characters.
bool IsOneLine(std::string_view text);

// Unicode code points to UTF-8 and back.

/// U+FEFF in UTF-8, which some writers put at the start of a text file.
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// The text without a byte-order mark at its start.
inline std::string_view WithoutByteOrderMark(std::string_view text) {
  return text.starts_with(kByteOrderMark) ? text.substr(kByteOrderMark.size()) : text;
}

/// Appends one code point; invalid ones (surrogates, above U+10FFFF) become U+FFFD.
void AppendUtf8(uint32_t code, std::string* text);

/// The code points of UTF-8 text; a malformed byte becomes the character of its value.
std::vector<uint32_t> CodePoints(std::string_view text);

}  // namespace bodyloom
