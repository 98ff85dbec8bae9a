// SPDX-License-Identifier: Apache-2.0
/// The stack machine that a pickle is a program for: runs its opcodes and builds inert values. Internal to pickle.cc.
/// Source: CPython Lib/pickletools.py.
#pragma once

#include <string_view>

#include "data_tools/formats/pickle_node.h"

namespace bodyloom {

/// What stands on top of the stack at STOP, starting at context->offset, which is left at the STOP mark. Text longer
/// than a few bytes still lies in `bytes` (PickleNode::view), and values may contain themselves: the caller finishes or
/// refuses them.
PickleNodePtr RunPickle(std::string_view bytes, PickleContext* context);

}  // namespace bodyloom
