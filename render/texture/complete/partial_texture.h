// SPDX-License-Identifier: Apache-2.0
/// Partial textures T_s: the part of the body's texture visible in an image, and combinations of several images.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/texture/complete/texel_neighbours.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

/// Planar; texels as in render/texture/photo_frame.h.
struct PartialTexture {
  int size = 0;
  std::vector<float> colour;     ///< 3 × U × U RGB in [0, 1]; 0 if neither visible nor guessed
  std::vector<uint8_t> visible;  ///< U × U, 0 or 1
  std::vector<uint8_t> labels;   ///< U × U: the image's label (1 for an image without labels); 0: not visible
  std::vector<float> cosine;     ///< U × U: between line of sight and surface normal; 0: not visible
  /// U × U, 0 or 1, never where visible (render/texture/complete/partial_texture.h); empty: nowhere
  std::vector<uint8_t> guessed;
};

/// A texel is visible where texel_cosine is not 0 and the pixel nearest to texel_pixels shows the person (label other
/// than 0; a frame without labels: a colour other than black). Its colour is the bilinear mean of the up to four pixels
/// around texel_pixels that show the person, with weights normalised to sum 1. Nothing is guessed. Throws
/// std::invalid_argument for a frame without an image or with sizes that do not fit each other.
PartialTexture PartialTextureOf(const PhotoFrame& frame);

/// Combines `garment` at the texels of `parts` with `texture` elsewhere: colours and visibility are copied bit for bit.
/// Texels of `parts` that the garment's image does not show become invisible, as they would show the person's old
/// clothes. Source: Sarkar et al., ECCV 2020, Section 4.5. Throws std::invalid_argument for textures of different sizes
/// or with guesses, which must be made after combining.
PartialTexture WithParts(const PartialTexture& texture, const PartialTexture& garment,
                         std::span<const uint8_t> texel_parts, std::span<const int> parts);

/// Union of the visible texels of several images of one person; each texel is taken from the most frontal image
/// (maximum cosine; the first of equals). Throws as WithParts.
PartialTexture UnionOf(std::span<const PartialTexture> textures);

/// Share of the atlas's texels (part other than 0) that is visible.
double VisibleShare(const PartialTexture& texture, std::span<const uint8_t> texel_parts);

/// Fills `colour` and `guessed` at invisible texels of the atlas from the nearest visible ones of the same label
/// (render/texture/complete/guess_unseen.h); a texture without visible texels stays. Throws std::invalid_argument for a
/// texture of another size.
void GuessTexture(const TexelNeighbours& neighbours, PartialTexture* texture);

}  // namespace bodyloom
