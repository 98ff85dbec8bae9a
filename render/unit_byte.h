// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>

namespace bodyloom {

/// A colour value in [0, 1] as a byte, rounded from 255 times it at its own precision; values beyond are cut off.
template <std::floating_point T>
uint8_t UnitByte(T value) {
  return static_cast<uint8_t>(std::lround(255 * std::clamp(value, T(0), T(1))));
}

/// The byte nearest to a value in [0, 255], halves upwards; std::lround is a call, and this is for every pixel.
inline uint8_t NearestByte(double value) {
  const double shifted = value + 0.5;
  return static_cast<uint8_t>(shifted);
}

}  // namespace bodyloom
