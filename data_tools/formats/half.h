// SPDX-License-Identifier: Apache-2.0
/// IEEE half precision, as .npy files and descriptors hold it.
#pragma once

#include <bit>
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
    value = static_cast<float>(fraction) * 0x1p-24F;
  } else {  // the same bits with another bias; weights of networks come by the million
    value = std::bit_cast<float>(static_cast<uint32_t>((exponent + 112) << 23 | fraction << 13));
  }
  return (half & 0x8000) != 0 ? -value : value;
}

}  // namespace bodyloom
