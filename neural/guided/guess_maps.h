// SPDX-License-Identifier: Apache-2.0
/// Guesses what the coherent maps do not hold from the nearest texels that they do (neural/people/texel_neighbours.h).
///
/// The label is the commonest one of the nearest filled texels, the colour the mean of the nearest ones of that label.
/// For the back of the head a face counts as hair (as skin where no hair is known).
#pragma once

#include <cstdint>
#include <span>

#include "bodyloom/neural/guided/coherent_maps.h"
#include "bodyloom/neural/people/texel_neighbours.h"

namespace bodyloom {

/// Fills every empty texel of the atlas as picture number `from` (1 to 255); maps that hold nothing stay empty.
/// Returns how many were filled. Throws std::invalid_argument for sizes that do
/// not fit.
int GuessRest(const TexelNeighbours& neighbours, uint8_t from, CoherentMaps* maps);

}  // namespace bodyloom
