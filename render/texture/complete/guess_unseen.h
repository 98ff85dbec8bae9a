// SPDX-License-Identifier: Apache-2.0
/// Guesses labels and colours of unseen texels from the nearest seen ones (texel_neighbours.h).
///
/// The label is the most frequent one of the nearest seen texels, the colour the mean of the nearest ones of that
/// label, so that colours do not mix between garments or between hair and face. For the back of the head a face counts
/// as hair; if no hair is seen, as skin with the colour of the nearest skin or face of the head.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/texture/complete/texel_neighbours.h"

namespace bodyloom {

/// `labels`: U × U, 0 where a texel is not seen, else 1 to 6 (photo_frame.h); `colours`: planar 3 × U × U. Overwrites
/// both at unseen texels of the atlas. Returns U × U: 1 at overwritten texels; none when no texel is seen. Throws
/// std::invalid_argument for arrays of other sizes.
std::vector<uint8_t> GuessUnseen(const TexelNeighbours& neighbours, std::span<uint8_t> labels,
                                 std::span<float> colours);

/// Corrects parsings without hair, which label the whole head as face: if `labels` have no hair, face texels on the
/// back of the head become hair.
void RelabelBackOfHeadAsHair(std::span<const uint8_t> back_of_head, std::span<uint8_t> labels);

}  // namespace bodyloom
