// SPDX-License-Identifier: Apache-2.0
/// The coherent maps of a source: what its photos show, and what is made up for the rest.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "neural/guided/coherent_maps.h"
#include "neural/guided/complete_maps.h"
#include "neural/guided/guided_config.h"
#include "render/texture/complete/texel_neighbours.h"

namespace bodyloom {

/// What is known of the source apart from its photos. What the completion does not need may be absent.
struct SourceBody {
  std::span<const uint8_t> texel_parts;            ///< U × U: DensePose's part, 0 where the atlas is empty
  std::span<const PhotoFrame> virtual_views = {};  ///< in the order of VirtualView; for MapCompletion::kVirtualViews
  const TexelNeighbours* neighbours = nullptr;     ///< for MapCompletion::kNearest and for SilNet's hints
  /// U × U: 1 where the last photo, somebody else's, says what is worn, and nobody else; elsewhere it says nothing.
  /// Empty: nobody lends anything.
  std::span<const uint8_t> lent_texels = {};
  /// False: of the photos' labels it is known only which are not the background; those of the maps are 1 where a photo
  /// fills them.
  bool garments_known = true;
};

struct SourceMaps {
  CoherentMaps maps;    ///< texels of photo i are from i + 1, the others from larger numbers
  int texels_seen = 0;  ///< that the photos filled
  std::vector<PersonPicture> virtual_pictures;
};

/// Of several photos the one that sees a texel at the largest cosine fills it, the first of equals. What a photo shows
/// of the back of the head (by the views or the neighbours) stays; where no photo's labels have hair, it is hair
/// whatever they call it (CallFacesBehindHair). `extent`: whether the clothes' extent is needed; it is measured on the
/// first photo (on the last one where that lends), and body.neighbours must be there. `draw` may be empty where nothing
/// is drawn. Throws std::invalid_argument for sizes that do not fit, and for what the completion needs and is absent.
SourceMaps MapsOfSource(std::span<const PhotoFrame> photos, const SourceBody& body, MapCompletion completion,
                        bool extent, const DrawPose& draw);

// Guesses what the coherent maps do not hold from the nearest texels that they do
// (render/texture/complete/guess_unseen.h).

/// Fills every empty texel of the atlas as picture number `from` (1 to 255); maps that hold nothing stay empty.
/// Returns how many were filled. Throws std::invalid_argument for sizes that do not fit.
int GuessRest(const TexelNeighbours& neighbours, uint8_t from, CoherentMaps* maps);

}  // namespace bodyloom
