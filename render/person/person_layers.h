// SPDX-License-Identifier: Apache-2.0
/// What is drawn of a person made from photos, plane by plane: what the picture refiner reads
/// (render/person/refiner_weights.h), and how its answer becomes a picture.
///
/// Colours are RGB in [0, 1] and not multiplied by alpha; where nobody is drawn they are those of the person nearby, so
/// that a silhouette which grows has something to be made of.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bodyloom/render/image.h"

namespace bodyloom {

/// Planes in their order.
struct PersonPlane {
  static constexpr int kColour = 0;  ///< 3: RGB
  static constexpr int kAlpha = 3;   ///< share of the pixel that shows the person
  static constexpr int kNormal = 4;  ///< 3: of the surface at the pixel's centre, camera frame; 0 where there is none
  static constexpr int kPlace = 7;   ///< 3: where that point lies on the body at rest, metres; 0 where there is none
  static constexpr int kSeen = 10;   ///< 1 where its colour was seen in a photo
  static constexpr int kMirrored = 11;  ///< 1 where it is the colour of its mirror image
  static constexpr int kCount = 12;
};

/// Sides of the layers' box are multiples of this.
inline constexpr int kLayersMultiple = 64;

struct PersonLayers {
  int x = 0, y = 0;           ///< pixel of the picture that is the box's first; may lie outside, where nobody is
  int width = 0, height = 0;  ///< of the box; 0: nobody is in the picture
  std::vector<float>
      planes;  ///< PersonPlane::kCount × height × width; of a PersonLayerPainter's DrawColours() the first 4

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

/// A box without planes around the pixels of a picture that are covered (not 0), as far from them on both sides, `reach` at
/// least. Nobody where none is.
PersonLayers BoxAround(int width, int height, std::span<const uint8_t> coverage, int reach);

/// Colours where alpha is above 0 as they are, elsewhere by pull–push: each 2×2 pixels' mean, weighted by alpha, flows
/// back into what has none. `colour`: 3 × height × width, in place. Nothing changes where alpha is 0 everywhere.
void FillAround(int width, int height, std::span<const float> alpha, std::span<float> colour);

/// How far the refiner may move the outline, pixels along x and y. Outwards as far as hair, hems and fingers stand off;
/// inwards no further than an outline that was measured in a photo is wrong: what clothes people like these wear says
/// nothing about the width of this one's trousers.
struct OutlineReach {
  static constexpr int kOutwards = 8, kInwards = 4;
};

/// Zeroes the change of alpha where it would go further: growth where nothing is drawn (alpha 0) up to kOutwards away, loss
/// where alpha is at least ½ up to kInwards away. `change`: 4 × height × width, in place. Throws std::invalid_argument for
/// another size.
void KeepNearOutline(const PersonLayers& layers, std::span<float> change);

/// The person as the refiner changes it. `change`, 4 × height × width, any numbers x:
///   colour' = clamp(colour + tanh x, 0, 1) of the first three planes,   alpha' = clamp(alpha + tanh x, 0, 1) of the last
/// so zeros change nothing. Returns 4 × height × width: colour', alpha'. Throws std::invalid_argument for another size.
std::vector<float> ChangedPerson(const PersonLayers& layers, std::span<const float> change);

/// The change of a small picture's layers as one of `layers`, whose picture is 1 / factor times as large: bilinear between
/// pixel centres, 0 outside the small box. Returns 4 × height × width of `layers`. Throws std::invalid_argument for a
/// change of another size than `small`, or a factor that is not positive.
std::vector<float> EnlargedChange(const PersonLayers& small, std::span<const float> change, double factor,
                                  const PersonLayers& layers);

/// Lays `person`, the four planes of ChangedPerson(), over a picture: colour'·alpha' + picture·(1 − alpha').
/// `coverage`, one a pixel of the picture or none, becomes 255·alpha' inside the box.
void LayOver(const PersonLayers& layers, std::span<const float> person, Image* picture, std::span<uint8_t> coverage);

}  // namespace bodyloom
