// SPDX-License-Identifier: Apache-2.0
/// The extent of clothes: how far they stand off the body at the silhouette of a photo, which distinguishes a skirt
/// from trousers where only the bare body of another pose is known.
///
/// A pixel of the person beside the body belongs to the nearest pixel on the body's rim (the larger of the distances
/// along x and y). A rim pixel's extent is the largest distance of those that belong to it, in diagonals of the box
/// around the torso's pixels (around all of the body's, over 3, where no torso is seen), so that it does not depend on
/// how large the person appears. Every texel takes the mean extent of the nearest rim texels
/// (neural/people/texel_neighbours.h).
#pragma once

#include <span>
#include <vector>

#include "bodyloom/neural/people/photo_frame.h"
#include "bodyloom/neural/people/texel_neighbours.h"

namespace bodyloom {

/// U × U, 0 where the atlas is empty, and everywhere when no rim is seen. Throws std::invalid_argument for a frame
/// without labels and for sizes that do not fit.
std::vector<float> ClothesExtent(const PhotoFrame& photo, const TexelNeighbours& neighbours);

/// Where clothes that stand off so far would be in another pose: with e(q) the extent at a pixel q of the body
/// (`extent`, S × S, as looked up there) and s the diagonal above in this pose,
///   1 on the body,   clamp(½ + max_q (s e(q) − |p − q|), 0, 1) at a pixel p beside it,
/// the distance being the larger one along x and y. Exact, two sweeps. Throws std::invalid_argument for sizes that do
/// not fit.
std::vector<float> ClothedBody(const PhotoFrame& pose, std::span<const float> extent);

}  // namespace bodyloom
