// SPDX-License-Identifier: Apache-2.0
/// Contract of every fuzz target: a reader may only fail with one line that names the file.
#pragma once

#include <stdexcept>
#include <string>

#include "data_tools/formats/printable.h"

namespace bodyloom::fuzz {

/// True when `action` returns, false when it throws std::runtime_error naming the file; other exceptions propagate.
template <typename Action>
bool Accepts(const Action& action) {
  try {
    action();
    return true;
  } catch (const std::runtime_error& error) {
    const std::string message = error.what();
    if (message.find("fuzz") == std::string::npos || !IsOneLine(message)) {
      throw std::logic_error("a message that does not name the file in one line: " + message);
    }
    return false;
  }
}

}  // namespace bodyloom::fuzz
