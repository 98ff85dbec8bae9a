// SPDX-License-Identifier: Apache-2.0
/// Numbers as text for people.
#pragma once

#include <cstdio>
#include <string>

namespace bodyloom {

/// With so many digits after the point: Fixed(1.25, 1) is "1.2".
inline std::string Fixed(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

}  // namespace bodyloom
