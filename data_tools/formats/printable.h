// SPDX-License-Identifier: Apache-2.0
/// Text from files in messages: one line, of bounded length, without control characters that a terminal would obey.
#pragma once

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

}  // namespace bodyloom
