// SPDX-License-Identifier: Apache-2.0
/// Boxes that networks with strides can look at instead of a whole window.
#pragma once

#include <vector>

#include "render/image/pixel_box.h"

namespace bodyloom {

/// Sides below which the deepest level of networks with a stride of `multiple` would have nothing to normalise over.
int LeastBoxSide(int multiple);

/// The smallest box that holds `box` (as far as it lies in the window), begins and ends at multiples of `multiple` and
/// has sides of at least `least_width` × `least_height` (or the window's): so a pixel keeps its place among the
/// strides, wherever the box lies. `window`: from (0, 0), its sides multiples of `multiple`. An empty box counts as the
/// window's middle.
PixelBox AlignedBox(const PixelBox& box, const PixelBox& window, int multiple, int least_width, int least_height);

/// One for each of `boxes`, all of one size: the largest of theirs, at least LeastBoxSide a side.
std::vector<PixelBox> AlignedBoxes(std::vector<PixelBox> boxes, const PixelBox& window, int multiple);

}  // namespace bodyloom
