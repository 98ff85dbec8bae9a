// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace bodyloom {

/// A colour value in [0, 1] as a byte, rounded; values beyond are cut off.
inline uint8_t UnitByte(double value) { return static_cast<uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0))); }

}  // namespace bodyloom
