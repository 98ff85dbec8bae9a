// SPDX-License-Identifier: Apache-2.0
/// Boxes aligned to the strides of networks, for inputs cropped from a window.
#pragma once

#include <vector>

#include "render/image/pixel_box.h"

namespace bodyloom {

/// Minimum side for which the deepest level of networks with a stride of `multiple` has enough pixels for
/// normalisation.
int MinBoxSide(int multiple);

/// The minimum box that contains `box` (clipped to the window), begins and ends at multiples of `multiple` and has
/// sides of at least `min_width` × `min_height` (or the window's): a pixel's phase with respect to the strides is the
/// same in all boxes. `window`: from (0, 0), its sides multiples of `multiple`. An empty box is taken as the window's
/// centre.
PixelBox AlignedBox(const PixelBox& box, const PixelBox& window, int multiple, int min_width, int min_height);

/// Aligned boxes of one size for all `boxes`: the maximum of their sizes, with sides of at least MinBoxSide.
std::vector<PixelBox> AlignedBoxes(std::vector<PixelBox> boxes, const PixelBox& window, int multiple);

}  // namespace bodyloom
