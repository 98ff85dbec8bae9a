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

/// Appends one code point; invalid ones (surrogates, above U+10FFFF) become U+FFFD.
void AppendUtf8(uint32_t code, std::string* text);

/// The code points of UTF-8 text; a malformed byte becomes the character of its value.
std::vector<uint32_t> CodePoints(std::string_view text);

}  // namespace bodyloom
