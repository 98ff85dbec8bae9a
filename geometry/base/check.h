// SPDX-License-Identifier: Apache-2.0
/// BODYLOOM_CHECK(condition, message...): throws std::invalid_argument when a caller broke a function's contract.
/// The message parts are streamed: BODYLOOM_CHECK(n == m, "poses has ", n, " columns, the body needs ", m).
/// Files and devices that cannot be used throw std::runtime_error instead.
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace bodyloom {

template <typename... Parts>
[[nodiscard]] std::string Concatenate(const Parts&... parts) {
  std::ostringstream stream;
  (stream << ... << parts);
  return stream.str();
}

}  // namespace bodyloom

#define BODYLOOM_CHECK(condition, ...)                                   \
  do {                                                                   \
    if (!(condition)) {                                                  \
      throw std::invalid_argument(::bodyloom::Concatenate(__VA_ARGS__)); \
    }                                                                    \
  } while (false)
