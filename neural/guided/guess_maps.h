// SPDX-License-Identifier: Apache-2.0
/// Guesses what the coherent maps do not hold from the nearest texels that they do (neural/people/guess_unseen.h).
#pragma once

#include <cstdint>

#include "bodyloom/neural/guided/coherent_maps.h"
#include "bodyloom/neural/people/texel_neighbours.h"

namespace bodyloom {

/// Fills every empty texel of the atlas as picture number `from` (1 to 255); maps that hold nothing stay empty.
/// Returns how many were filled. Throws std::invalid_argument for sizes that do not fit.
int GuessRest(const TexelNeighbours& neighbours, uint8_t from, CoherentMaps* maps);

}  // namespace bodyloom
