// SPDX-License-Identifier: Apache-2.0
/// T_s: what a picture shows of the body's texture, and textures put together from several pictures.
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
  std::vector<float> colour;     ///< 3 × U × U RGB in [0, 1]; 0 where neither visible nor guessed
  std::vector<uint8_t> visible;  ///< U × U, 0 or 1
  std::vector<uint8_t> labels;   ///< U × U: the picture's label there (1 of a picture without labels); 0: not visible
  std::vector<float> cosine;     ///< U × U: of the line of sight to the surface's normal; 0: not visible
  /// U × U, 0 or 1, never where visible (render/texture/complete/partial_texture.h); empty: nowhere
  std::vector<uint8_t> guessed;
};

/// A texel is visible where texel_cosine is not 0 and the pixel nearest to texel_pixels shows the person (label other
/// than 0; a frame without labels: a colour other than black). Its colour is the bilinear mean of the up to four pixels
/// around texel_pixels that show the person, their weights made to sum to 1. Nothing is guessed. Throws
/// std::invalid_argument for a frame without a picture or with sizes that do not fit each other.
PartialTexture PartialTextureOf(const PhotoFrame& frame);

/// `texture` where `texel_parts` is none of `parts`, `garment` elsewhere: colours and visibility are copied as they
/// are, bit for bit. Texels that the garment's picture does not show become invisible: what the person wore there is
/// not wanted. Source: Sarkar et al., ECCV 2020, Section 4.5. Throws std::invalid_argument for textures of different
/// sizes or with guesses: a guess is made of all that is seen in the end.
PartialTexture WithParts(const PartialTexture& texture, const PartialTexture& garment,
                         std::span<const uint8_t> texel_parts, std::span<const int> parts);

/// What any of the pictures shows of one person; where several do, the one counts that sees the texel most from the
/// front (the largest cosine; the first of equals). Throws as WithParts.
PartialTexture UnionOf(std::span<const PartialTexture> textures);

/// Share of the atlas's texels (part other than 0) that is visible.
double VisibleShare(const PartialTexture& texture, std::span<const uint8_t> texel_parts);

// Colours of the texels that a picture does not show, from the nearest ones that it does of the same label: one
// garment, hair, skin or face (render/texture/complete/guess_unseen.h).

/// Fills `colour` and `guessed` where the atlas has a texel that is not visible; a texture that shows nothing stays as
/// it is. Throws std::invalid_argument for a texture of another size.
void GuessTexture(const TexelNeighbours& neighbours, PartialTexture* texture);

}  // namespace bodyloom
