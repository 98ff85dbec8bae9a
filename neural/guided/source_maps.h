// SPDX-License-Identifier: Apache-2.0
/// Builds the coherent maps of a source from its photos and completes them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "neural/guided/coherent_maps.h"
#include "neural/guided/complete_maps.h"
#include "neural/guided/guided_config.h"
#include "render/texture/complete/texel_neighbours.h"

namespace bodyloom {

/// Data of the source besides its photos. Fields that the completion does not need may be absent.
struct SourceBody {
  std::span<const uint8_t> texel_parts;            ///< U × U: DensePose's part, 0 where the atlas is empty
  std::span<const PhotoFrame> virtual_views = {};  ///< in the order of VirtualView; for MapCompletion::kVirtualViews
  const TexelNeighbours* neighbours = nullptr;     ///< for MapCompletion::kNearest and for SilNet's hints
  /// U × U: 1 where clothes are taken only from the last photo, of another person, which is not used elsewhere. Empty:
  /// no such photo.
  std::span<const uint8_t> lent_texels = {};
  /// False: the photos' labels distinguish only person and background; labels of the maps are 1 where a photo fills
  /// them.
  bool garments_known = true;
};

struct SourceMaps {
  CoherentMaps maps;    ///< texels of photo i have number i + 1, completed ones larger numbers
  int texels_seen = 0;  ///< number filled by photos
  std::vector<RenderedPerson> virtual_images;
};

/// A texel is filled from the photo that sees it at the maximum cosine, the first of equals. Photos' texels of the back
/// of the head (by the views or the neighbours) are kept; if no photo's labels have hair, they become hair
/// (RelabelBackOfHeadAsHair). `clothes_offset`: true if the clothes' offset is needed; it is measured on the first
/// photo (on the last one if clothes are taken from it), and requires body.neighbours. `draw` may be empty if nothing
/// is rendered. Throws std::invalid_argument for sizes that do not fit, and for missing data that the completion needs.
SourceMaps MapsOfSource(std::span<const PhotoFrame> photos, const SourceBody& body, MapCompletion completion,
                        bool clothes_offset, const DrawPose& draw);

/// Fills every empty texel of the atlas from the nearest filled ones (render/texture/complete/guess_unseen.h), as image
/// number `from` (1 to 255); empty maps stay empty.
/// Returns the number of filled texels. Throws std::invalid_argument for sizes that do not fit.
int CompleteEmptyTexels(const TexelNeighbours& neighbours, uint8_t from, CoherentMaps* maps);

}  // namespace bodyloom
