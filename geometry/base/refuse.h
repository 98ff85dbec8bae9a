// SPDX-License-Identifier: Apache-2.0
/// How files that cannot be used are refused.
#pragma once

#include <stdexcept>
#include <string>

namespace bodyloom {

/// Throws std::runtime_error "where: message"; `where` names the file or the place in it.
[[noreturn]] inline void Refuse(const std::string& where, const std::string& message) {
  throw std::runtime_error(where + ": " + message);
}

/// The same for one entry of a file: "where: key: message".
[[noreturn]] inline void Refuse(const std::string& where, const std::string& key, const std::string& message) {
  throw std::runtime_error(where + ": " + key + ": " + message);
}

}  // namespace bodyloom
