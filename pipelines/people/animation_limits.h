// SPDX-License-Identifier: Apache-2.0
/// What holds of every video of a person who is moved by a track.
#pragma once

namespace bodyloom {

inline constexpr double kFpsWithoutTimes = 30;  ///< frame rate of a track without times
inline constexpr int kLongestPictureSide = 8192;

}  // namespace bodyloom
