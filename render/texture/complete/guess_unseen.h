// SPDX-License-Identifier: Apache-2.0
/// A guess at labels and colours of the texels that no picture shows, from the nearest ones shown (texel_neighbours.h).
///
/// The label is the commonest of the nearest shown texels, the colour the mean of the nearest ones of that label, so
/// that no garment takes another's colour, nor hair a face's. For the back of the head a face counts as hair; where no
/// hair is shown, as skin, which then has the colour of the nearest skin or face of the head, not of any hand.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/texture/complete/texel_neighbours.h"

namespace bodyloom {

/// `labels`: U × U, 0 where a texel is not shown, else 1 to 6 (photo_frame.h); `colours`: planar 3 × U × U. Overwrites
/// both at the texels of the atlas that are not shown. Returns U × U: 1 where it did; nowhere when nothing is shown.
/// Throws std::invalid_argument for arrays of other sizes.
std::vector<uint8_t> GuessUnseen(const TexelNeighbours& neighbours, std::span<uint8_t> labels,
                                 std::span<float> colours);

/// A parsing without hair calls all of a head its face. Where `labels` have no hair, what they call a face on the back
/// of the head becomes hair.
void CallFacesBehindHair(std::span<const uint8_t> back_of_head, std::span<uint8_t> labels);

}  // namespace bodyloom
