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

namespace bodyloom {

// Errors about files that cannot be used.

/// Throws std::runtime_error "where: message"; `where` names the file or the place in it.
[[noreturn]] inline void ThrowFileError(const std::string& where, const std::string& message) {
  throw std::runtime_error(where + ": " + message);
}

/// The same for one entry of a file: "where: key: message".
[[noreturn]] inline void ThrowFileError(const std::string& where, const std::string& key, const std::string& message) {
  throw std::runtime_error(where + ": " + key + ": " + message);
}

// Ranges of options, for IsValid() of option structs.

/// in_range("steps", steps, 1, 1e8)returns true if low ≤ value ≤ high. Otherwise, NaN included, `why` (which may be
/// nullptr) becomes "steps is 0, expected 1 to 1e+08".
class InRange {
 public:
  explicit InRange(std::string* why) : why_(why) {}
  bool operator()(const char* name, double value, double low, double high) const {
    if (value >= low && value <= high) return true;
    if (why_ != nullptr) *why_ = Concatenate(name, " is ", value, ", expected ", low, " to ", high);
    return false;
  }

 private:
  std::string* why_;
};

}  // namespace bodyloom
