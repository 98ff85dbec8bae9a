// SPDX-License-Identifier: Apache-2.0
/// Estimates the background of a clip from a static camera: a colour and a standard deviation for every pixel.
///
/// The colour is the median of each channel over the images in which nobody covers the pixel. Its σ is 1.48 times the
/// median absolute deviation (MAD, the largest of the channels), joined with 3 levels (camera noise, compression) and
/// with a third of the step to the next pixels (edges move by a fraction of a pixel):
///   σ² = (1.48 MAD)² + 3² + (|∇B|/3)²
/// A pixel that fewer than `fewest` images show is not known. The camera counts as static when at least half of the
/// pixels are known and at most a tenth of them have a MAD above 8 levels.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "render/image/image.h"

namespace bodyloom {

struct StillBackground {
  Image colours;             ///< black where not known
  std::vector<float> sigma;  ///< levels of 255, a pixel; 0: not known
};

/// An image of the clip, and a mask of the people in it.
struct CoveredImage {
  Image image;
  std::vector<uint8_t> covered;  ///< width·height; not 0: somebody may be there
};

struct StillBackgroundOptions {
  int fewest = 5;  ///< 1 or more
  int num_threads = 1;
};

/// None when the camera moves, or people always cover half of the image. About thirty images spread over the clip are
/// enough. Throws std::invalid_argument for images of different sizes.
std::optional<StillBackground> FindStillBackground(std::span<const CoveredImage> images,
                                                   const StillBackgroundOptions& options = {});

}  // namespace bodyloom
