// SPDX-License-Identifier: Apache-2.0
/// The stack machine that runs a pickle's opcodes and builds inert values. Internal to pickle.cc. Source: CPython
/// Lib/pickletools.py.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "data_tools/formats/pickle_node.h"

namespace bodyloom {

/// Runs from context->offset to the STOP mark, where it leaves the offset, and returns the top of the stack. Text
/// longer than a few bytes still refers to `bytes` (PickleNode::view), and values may contain themselves: the caller
/// finishes or refuses them.
PickleNodePtr RunPickle(std::string_view bytes, PickleContext* context);

// Decodes the two string formats of text pickles (protocol 0).

/// Python 2's repr of a str, quotes and backslash escapes resolved; nullopt when it is malformed.
std::optional<std::string> UnquotePython2(std::string_view line);

/// latin-1 with \uXXXX and \UXXXXXXXX escapes (Python's raw-unicode-escape) as UTF-8; nullopt when an escape is
/// malformed.
std::optional<std::string> DecodeRawUnicode(std::string_view line);

}  // namespace bodyloom
