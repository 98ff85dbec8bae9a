// SPDX-License-Identifier: Apache-2.0
/// Colours of the texels that a picture does not show, from the nearest ones that it does of the same label: one
/// garment, hair, skin or face (neural/people/guess_unseen.h).
#pragma once

#include "bodyloom/neural/people/texel_neighbours.h"
#include "bodyloom/neural/photo/partial_texture.h"

namespace bodyloom {

/// Fills `colour` and `guessed` where the atlas has a texel that is not visible; a texture that shows nothing stays as
/// it is. Throws std::invalid_argument for a texture of another size.
void GuessTexture(const TexelNeighbours& neighbours, PartialTexture* texture);

}  // namespace bodyloom
