// SPDX-License-Identifier: Apache-2.0
/// What is known of a person in a picture, plane by plane: what the clothes parser reads
/// (render/image/parser_weights.h). Colours are RGB in [0, 1].
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace bodyloom {

/// Planes in their order.
struct PersonPlane {
  static constexpr int kColour = 0;  ///< 3: RGB
  static constexpr int kAlpha = 3;   ///< share of the pixel that shows the person
  static constexpr int kNormal = 4;  ///< 3: of the surface at the pixel's centre, camera frame; 0 where there is none
  static constexpr int kPlace = 7;   ///< 3: where that point lies on the body at rest, metres; 0 where there is none
  static constexpr int kCount = 10;
};

/// Sides of the layers' box are multiples of this.
inline constexpr int kLayersMultiple = 64;

struct PersonLayers {
  int x = 0, y = 0;           ///< pixel of the picture that is the box's first; may lie outside, where nobody is
  int width = 0, height = 0;  ///< of the box; 0: nobody is in the picture
  std::vector<float> planes;  ///< PersonPlane::kCount × height × width

  [[nodiscard]] size_t pixels() const { return static_cast<size_t>(width) * height; }
  [[nodiscard]] std::span<const float> Plane(int plane) const {
    return std::span(planes).subspan(plane * pixels(), pixels());
  }
};

/// visit(x, y, i): the pixels of a picture of width × height that lie in the box, and where they are in a plane.
template <typename Visit>
void ForEachPixel(const PersonLayers& layers, int width, int height, const Visit& visit) {
  for (int v = std::max(0, -layers.y); v < std::min(layers.height, height - layers.y); ++v) {
    for (int u = std::max(0, -layers.x); u < std::min(layers.width, width - layers.x); ++u) {
      visit(layers.x + u, layers.y + v, static_cast<size_t>(v) * layers.width + u);
    }
  }
}

/// A box without planes around the pixels of a picture that are covered (not 0), as far from them on both sides,
/// `reach` at least. Nobody where none is.
PersonLayers BoxAround(int width, int height, std::span<const uint8_t> coverage, int reach);

}  // namespace bodyloom
