// SPDX-License-Identifier: Apache-2.0
/// The coherent maps L and A of the pose-guided renderer: garment labels and appearance on the body's surface, the same
/// in every frame.
///
/// Images fill the texels that they show and that no earlier one filled; the pseudo inputs of all poses are sampled
/// from the same maps: G̃ = L(W_t), Ĩ = A(W_t). A pixel's value depends on its atlas coordinates and its part alone, so
/// that a point of the body has one colour in all frames. Source: Yoon et al., CVPR 2021, Section 3.2.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "neural/base/rendered_person.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

/// The pseudo inputs G̃, Ĩ, S̃ of a pose, before completion. Planar, size × size.
struct PseudoImage {
  int size = 0;
  std::vector<float> image;           ///< 3; 0 where not known
  std::vector<uint8_t> labels;        ///< 0 where not known
  std::vector<uint8_t> known;         ///< S̃
  std::vector<float> clothes_offset;  ///< offset of clothes from the body (clothes_offset_map.h); empty: not known
  std::vector<float> clothed;         ///< predicted clothed silhouette; empty: not known
};

struct CoherentMaps {
  int size = 0;                       ///< U
  std::vector<float> appearance;      ///< 3 × U × U RGB
  std::vector<uint8_t> labels;        ///< U × U
  std::vector<uint8_t> from;          ///< U × U: number of the image that filled the texel, 0: empty
  std::vector<uint8_t> texel_parts;   ///< U × U: DensePose's part, 0 where the atlas is empty
  std::vector<float> clothes_offset;  ///< U × U: offset of clothes (clothes_offset_map.h); empty: not known
};

CoherentMaps EmptyMaps(int size, std::span<const uint8_t> texel_parts);

/// Fills the empty texels of the frame's body that are visible inside the person: label of the nearest pixel, mean
/// colour of those of the four surrounding pixels that belong to the person (divided by alpha). `from`: 1 to 255.
/// `no_face`: U × U or empty; texels that are not filled from face pixels. Returns the number of filled texels.
int FillEmptyTexels(const PhotoFrame& frame, const RenderedPerson& rendered, uint8_t from,
                    std::span<const uint8_t> no_face, CoherentMaps* maps);

/// Converts the frame's own image and labels to a RenderedPerson: alpha is 1 where the label is not 0.
RenderedPerson OwnImage(const PhotoFrame& frame);

/// Maps filled by photos only: photo i fills texels as image i + 1.
CoherentMaps MapsOf(std::span<const PhotoFrame> photos, std::span<const uint8_t> texel_parts);

/// Share of the atlas filled by the first `images` images of the maps.
double ShareFilled(const CoherentMaps& maps, size_t images);

/// Samples the maps at the pixels of the bare body in a pose: bilinear over the filled texels of the pixel's part;
/// label of the nearest of them. Not known where less than half the weight is filled. The offset is bilinear over all
/// texels.
PseudoImage LookUp(const CoherentMaps& maps, const PhotoFrame& frame);

}  // namespace bodyloom
