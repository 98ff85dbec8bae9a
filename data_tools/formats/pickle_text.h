// SPDX-License-Identifier: Apache-2.0
/// Decodes the two string formats of text pickles (protocol 0).
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace bodyloom {

/// Python 2's repr of a str, quotes and backslash escapes resolved; nullopt when it is malformed.
std::optional<std::string> UnquotePython2(std::string_view line);

/// latin-1 with \uXXXX and \UXXXXXXXX escapes (Python's raw-unicode-escape) as UTF-8; nullopt when an escape is
/// malformed.
std::optional<std::string> DecodeRawUnicode(std::string_view line);

}  // namespace bodyloom
