// SPDX-License-Identifier: Apache-2.0
/// What stands behind the people of a clip whose camera stands still: a colour of every pixel, and how much it varies.
///
/// Of the pictures in which nobody covers a pixel, each channel's median; its spread σ is 1.48 times the median of the
/// largest channel's distance from it, joined with 3 levels (a camera's noise, compression) and with a third of the
/// step to the next pixels (edges tremble by a part of a pixel):
///   σ² = (1.48 MAD)² + 3² + (|∇B|/3)²
/// A pixel that fewer than `fewest` pictures show is not known. The camera counts as still when at least half of the
/// pixels are known and at most a tenth of them have a MAD above 8 levels.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "render/image/image.h"

namespace bodyloom {

struct StillBackground {
  Image colours;             ///< black where it is not known
  std::vector<float> sigma;  ///< levels of 255, a pixel; 0: not known
};

/// A picture of the clip, and where people may be in it.
struct CoveredPicture {
  Image picture;
  std::vector<uint8_t> covered;  ///< width·height; not 0: somebody may be there
};

struct StillBackgroundOptions {
  int fewest = 5;  ///< 1 or more
  int num_threads = 1;
};

/// None when the camera moves, or people cover half of the picture all the time. Some thirty pictures from all over the
/// clip will do. Throws std::invalid_argument for pictures of different sizes.
std::optional<StillBackground> FindStillBackground(std::span<const CoveredPicture> pictures,
                                                   const StillBackgroundOptions& options = {});

}  // namespace bodyloom
