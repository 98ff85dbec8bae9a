// SPDX-License-Identifier: Apache-2.0
/// Unicode code points to UTF-8 and back.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace bodyloom {

/// Appends one code point; what is no character (surrogates, above U+10FFFF) becomes U+FFFD.
void AppendUtf8(uint32_t code, std::string* text);

/// The code points of UTF-8 text; a malformed byte counts as the character of its value.
std::vector<uint32_t> CodePoints(std::string_view text);

}  // namespace bodyloom
