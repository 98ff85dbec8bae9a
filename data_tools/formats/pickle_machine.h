// SPDX-License-Identifier: Apache-2.0
/// The stack machine that runs a pickle's opcodes and builds inert values. Internal to pickle.cc. Source: CPython
/// Lib/pickletools.py.
#pragma once

#include <string_view>

#include "data_tools/formats/pickle_node.h"

namespace bodyloom {

/// Runs from context->offset to the STOP mark, where it leaves the offset, and returns the top of the stack. Text
/// longer than a few bytes still refers to `bytes` (PickleNode::view), and values may contain themselves: the caller
/// finishes or refuses them.
PickleNodePtr RunPickle(std::string_view bytes, PickleContext* context);

}  // namespace bodyloom
