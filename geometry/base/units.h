// SPDX-License-Identifier: Apache-2.0
/// Units in which files, options and tables speak, in ours (metres, radians), and back.
#pragma once

#include <numbers>

namespace bodyloom {

inline constexpr double kDegree = std::numbers::pi / 180;
inline constexpr double kCentimetre = 1e-2;
inline constexpr double kMmPerMetre = 1e3;

}  // namespace bodyloom
