// SPDX-License-Identifier: Apache-2.0
/// Units in which files and options speak, in ours (metres, radians).
#pragma once

#include <numbers>

namespace bodyloom {

inline constexpr double kDegree = std::numbers::pi / 180;
inline constexpr double kCentimetre = 1e-2;

}  // namespace bodyloom
