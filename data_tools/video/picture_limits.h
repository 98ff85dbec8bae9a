// SPDX-License-Identifier: Apache-2.0
/// How large a picture may be, still or moving: files that promise more are refused before memory is taken.
#pragma once

#include <cstdint>

namespace bodyloom {

inline constexpr int64_t kMaxPicturePixels = int64_t{1} << 26;

}  // namespace bodyloom
