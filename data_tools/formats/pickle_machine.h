// SPDX-License-Identifier: Apache-2.0
/// The stack machine that a pickle is a program for: runs its opcodes and builds inert values. Internal to pickle.cc.
/// Source: CPython Lib/pickletools.py.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "data_tools/formats/pickle_node.h"

namespace bodyloom {

/// What stands on top of the stack at STOP, starting at context->offset, which is left at the STOP mark. Text longer
/// than a few bytes still lies in `bytes` (PickleNode::view), and values may contain themselves: the caller finishes or
/// refuses them.
PickleNodePtr RunPickle(std::string_view bytes, PickleContext* context);

// The two ways in which text pickles (protocol 0) write strings.

/// Python 2's repr of a str, quotes and backslash escapes resolved; nothing when it is malformed.
std::optional<std::string> UnquotePython2(std::string_view line);

/// latin-1 with \uXXXX and \UXXXXXXXX escapes (Python's raw-unicode-escape) as UTF-8; nothing when an escape is broken.
std::optional<std::string> DecodeRawUnicode(std::string_view line);

}  // namespace bodyloom
