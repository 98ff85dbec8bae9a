// SPDX-License-Identifier: Apache-2.0
/// L and A of the pose-guided renderer: garment labels and appearance on the body's surface, the same in every frame.
///
/// Pictures fill texels that they see and that no earlier one filled; every pose looks its pseudo inputs up in the same
/// maps: G̃ = L(W_t), Ĩ = A(W_t). A pixel's value depends on its atlas coordinates and its part alone, so that a point
/// of the body has one colour in all frames. Source: Yoon et al., CVPR 2021, Section 3.2.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "neural/base/person_picture.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

/// G̃, Ĩ, S̃: what is known of a pose before anything is completed. Planar, size × size.
struct PseudoPicture {
  int size = 0;
  std::vector<float> image;     ///< 3; 0 where nothing is known
  std::vector<uint8_t> labels;  ///< 0 where nothing is known
  std::vector<uint8_t> known;   ///< S̃
  std::vector<float> extent;    ///< how far clothes stand off the body (clothes_extent.h); empty: nobody knows
  std::vector<float> clothed;   ///< the body as far as clothes would stand off; empty as well
};

struct CoherentMaps {
  int size = 0;                      ///< U
  std::vector<float> appearance;     ///< 3 × U × U RGB
  std::vector<uint8_t> labels;       ///< U × U
  std::vector<uint8_t> from;         ///< U × U: number of the picture that filled the texel, 0: empty
  std::vector<uint8_t> texel_parts;  ///< U × U: DensePose's part, 0 where the atlas is empty
  std::vector<float> extent;         ///< U × U: how far clothes stand off (clothes_extent.h); empty: nobody knows
};

CoherentMaps EmptyMaps(int size, std::span<const uint8_t> texel_parts);

/// Fills the empty texels that the frame's body shows inside the person: label of the nearest pixel, mean colour of the
/// four around it that belong to the person (divided by alpha). `from`: 1 to 255. `no_face`: U × U or empty; texels
/// that are not filled where the picture shows a face. Returns how many were filled.
int FillEmptyTexels(const PhotoFrame& frame, const PersonPicture& picture, uint8_t from,
                    std::span<const uint8_t> no_face, CoherentMaps* maps);

/// The frame's own picture, from its image and labels: alpha is 1 where a label is not 0.
PersonPicture OwnPicture(const PhotoFrame& frame);

/// What photos show of the body and no more: photo i fills texels as picture i + 1.
CoherentMaps MapsOf(std::span<const PhotoFrame> photos, std::span<const uint8_t> texel_parts);

/// Share of the atlas that the first `pictures` pictures of the maps filled.
double ShareFilled(const CoherentMaps& maps, size_t pictures);

/// What the maps show of a pose, at the pixels of the bare body: bilinear among the filled texels of the pixel's part;
/// label of the nearest of them. Nothing where less than half the weight is filled. The extent is bilinear among all.
PseudoPicture LookUp(const CoherentMaps& maps, const PhotoFrame& frame);

}  // namespace bodyloom
