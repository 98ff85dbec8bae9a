// SPDX-License-Identifier: Apache-2.0
/// Conversion factors between units of files, options and tables and the internal ones (metres, radians).
#pragma once

#include <numbers>

namespace bodyloom {

inline constexpr double kDegree = std::numbers::pi / 180;
inline constexpr double kCentimetre = 1e-2;
inline constexpr double kMmPerMetre = 1e3;

}  // namespace bodyloom
