// SPDX-License-Identifier: Apache-2.0
/// IEEE half precision, as .npy files and descriptors hold it.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace bodyloom {

/// The value of 16 bits; exact. Subnormal numbers, infinities and NaN included.
inline float FloatFromHalf(uint16_t half) {
  const int exponent = (half >> 10) & 31;
  const int fraction = half & 1023;
  float value = 0;
  if (exponent == 31) {
    value = fraction == 0 ? std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
  } else if (exponent == 0) {
    value = std::ldexp(static_cast<float>(fraction), -24);
  } else {
    value = std::ldexp(static_cast<float>(fraction + 1024), exponent - 25);
  }
  return (half & 0x8000) != 0 ? -value : value;
}

}  // namespace bodyloom
