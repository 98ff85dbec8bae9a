// SPDX-License-Identifier: Apache-2.0
/// Pictures with transparency.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace bodyloom {

/// An 8-bit PNG of blue, green, red (straight, not multiplied by alpha) and alpha, four bytes a pixel in rows from the
/// top. Whole or not at all. Throws std::invalid_argument for another number of bytes than the size asks for,
/// std::runtime_error naming the path.
void WriteAlphaPng(const std::string& path, int width, int height, std::span<const uint8_t> bgra);

}  // namespace bodyloom
