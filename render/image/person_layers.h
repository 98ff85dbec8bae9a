// SPDX-License-Identifier: Apache-2.0
/// Input planes of the clothes parser (render/image/parser_weights.h) for a person in an image. Colours are RGB in [0,
/// 1].
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace bodyloom {

/// Indices of the planes.
struct PersonPlane {
  static constexpr int kColour = 0;  ///< 3: RGB
  static constexpr int kAlpha = 3;   ///< coverage of the pixel by the person
  static constexpr int kNormal = 4;  ///< 3: of the surface at the pixel's centre, camera frame; 0 if there is none
  static constexpr int kPlace = 7;   ///< 3: rest position of that point, metres; 0 where there is none
  static constexpr int kCount = 10;
};

/// Sides of the layers' box are multiples of this.
inline constexpr int kLayersMultiple = 64;

struct PersonLayers {
  int x = 0, y = 0;           ///< image pixel of the box's first; may lie outside the image, where planes are empty
  int width = 0, height = 0;  ///< of the box; 0: no person in the image
  std::vector<float> planes;  ///< PersonPlane::kCount × height × width

  [[nodiscard]] size_t pixels() const { return static_cast<size_t>(width) * height; }
  [[nodiscard]] std::span<const float> Plane(int plane) const {
    return std::span(planes).subspan(plane * pixels(), pixels());
  }
};

/// Calls visit(x, y, i) for the pixels of a width × height image that lie in the box; i is their index in a plane.
template <typename Visit>
void ForEachPixel(const PersonLayers& layers, int width, int height, const Visit& visit) {
  for (int v = std::max(0, -layers.y); v < std::min(layers.height, height - layers.y); ++v) {
    for (int u = std::max(0, -layers.x); u < std::min(layers.width, width - layers.x); ++u) {
      visit(layers.x + u, layers.y + v, static_cast<size_t>(v) * layers.width + u);
    }
  }
}

/// Box, without planes, around the covered pixels of an image (not 0), centred on them, with a margin of at least
/// `reach`. Empty if no pixel is covered.
PersonLayers BoxAround(int width, int height, std::span<const uint8_t> coverage, int reach);

}  // namespace bodyloom
