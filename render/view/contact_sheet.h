// SPDX-License-Identifier: Apache-2.0
/// Arranges pictures on a contact sheet to judge a clip at a glance.
#pragma once

#include <vector>

#include "render/image/image.h"

namespace bodyloom {

struct ContactSheetOptions {
  int columns = 0;           ///< 0: chosen to make the sheet as square as possible
  int cell_height_px = 360;  ///< pictures are scaled to this height
  int gap_px = 6;
  Colour background{26, 32, 44};
};

/// Arranges pictures in rows from left to right, scaled to one height; each cell is as wide as the widest picture, and
/// pictures are centred in their cells. Throws std::invalid_argument for an empty list or an empty picture.
Image ContactSheet(const std::vector<Image>& images, const ContactSheetOptions& options = {});

/// `count` indices spread evenly over 0..num_frames−1, first and last included (one: the middle); fewer if there are
/// fewer frames.
std::vector<int> EvenlySpreadFrames(int num_frames, int count);

}  // namespace bodyloom
