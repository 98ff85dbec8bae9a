// SPDX-License-Identifier: Apache-2.0
/// Appearance of a person rendered from photos: the texture that they show, parts of it lent by somebody else.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bodyloom/neural/photo/partial_texture.h"
#include "bodyloom/pipelines/neural/photo/photo_input.h"

namespace bodyloom {

/// Somebody who lends a part of his or her appearance.
struct LentGarment {
  std::string from;                ///< IMAGE:TRACK[:FRAME] (ParsePhotoRequest); empty: nobody
  std::vector<std::string> parts;  ///< "top", "bottom", "shoes", "head", "arms" or a DensePose part, "1" to "24"
};

/// DensePose's parts of "top", "bottom", "shoes", "head", "arms" (below the elbow, with hands) or a number. Throws
/// RequestError for other names.
std::vector<int> PartsNamed(const std::vector<std::string>& names);

/// U × U: 1 where `garment` replaces what the person wears by what `lender` does. Adds to `notes` a line that says how
/// much of that the lender's photo shows. Throws std::runtime_error when it shows nothing of it.
std::vector<uint8_t> LentTexels(const LentGarment& garment, const Photo& lender, std::span<const uint8_t> texel_parts,
                                std::string* notes);

/// The union of what the photos show; where somebody lends, the last of them shows what. Adds to `notes` and throws
/// as LentTexels.
PartialTexture AppearanceOf(std::span<const Photo> photos, const LentGarment& garment,
                            std::span<const uint8_t> texel_parts, std::string* notes);

}  // namespace bodyloom
