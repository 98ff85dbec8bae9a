// SPDX-License-Identifier: Apache-2.0
/// An 8-bit colour image that owns its pixels, and basic operations on it.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace bodyloom {

struct Colour {
  uint8_t red = 0, green = 0, blue = 0;
  bool operator==(const Colour&) const = default;
};

/// Rows from top to bottom, three bytes per pixel in the order blue, green, red (OpenCV's).
struct Image {
  int width = 0, height = 0;
  std::vector<uint8_t> bgr;

  Image() = default;
  /// Throws std::invalid_argument for a negative size.
  Image(int width, int height, Colour fill = {});
  [[nodiscard]] bool empty() const { return width <= 0 || height <= 0; }
  [[nodiscard]] uint8_t* pixel(int x, int y) { return &bgr[3 * (size_t(y) * width + x)]; }
  [[nodiscard]] const uint8_t* pixel(int x, int y) const { return &bgr[3 * (size_t(y) * width + x)]; }
  [[nodiscard]] Colour at(int x, int y) const { return {pixel(x, y)[2], pixel(x, y)[1], pixel(x, y)[0]}; }
  bool operator==(const Image&) const = default;
};

/// Backdrop used without a video: grey, darker towards the corners.
Image StudioBackdrop(int width, int height);

/// Area mean when shrinking, bicubic when growing.
Image Resized(const Image& image, int width, int height);

/// Copies `source` into `target` with its top-left pixel at (x, y); clipped at the borders.
void Paste(const Image& source, int x, int y, Image* target);

/// Converts a colour value in [0, 1] to a byte: 255 times the value, rounded at its own precision; clamped.
template <std::floating_point T>
uint8_t UnitByte(T value) {
  return static_cast<uint8_t>(std::lround(255 * std::clamp(value, T(0), T(1))));
}

/// The byte nearest to a value in [0, 255], halves rounded up; faster than std::lround in loops over pixels.
inline uint8_t NearestByte(double value) {
  const double shifted = value + 0.5;
  return static_cast<uint8_t>(shifted);
}

}  // namespace bodyloom
