// SPDX-License-Identifier: Apache-2.0
/// Text from files in messages: one line, of bounded length, without control characters that a terminal would obey.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace bodyloom {

/// At most 80 characters; everything but printable ASCII becomes '?'.
std::string PrintableText(std::string_view text);

/// "a, b, c": the first twenty names, then how many more; "nothing" for none.
std::string PrintableList(const std::vector<std::string>& names);

/// False when the text holds ASCII control characters.
bool IsOneLine(std::string_view text);

// Unicode code points to UTF-8 and back.

/// Appends one code point; what is no character (surrogates, above U+10FFFF) becomes U+FFFD.
void AppendUtf8(uint32_t code, std::string* text);

/// The code points of UTF-8 text; a malformed byte counts as the character of its value.
std::vector<uint32_t> CodePoints(std::string_view text);

}  // namespace bodyloom
