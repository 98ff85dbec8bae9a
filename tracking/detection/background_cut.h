// SPDX-License-Identifier: Apache-2.0
/// A person's mask cut anew where the background is known: a network's mask takes objects and light beside the person
/// along, and its outline is off by some pixels.
///
/// The cut is the minimum over masks of Σ_pixels unary + Σ_neighbours λ e^(−c²/2β) [one in, one out], β the mean of c²
/// over the window:
///   out   −log(0.99 N(I; gB, σ) + 1/256³/100), or darker by a shadow: the nearest sB with s in [0.55, 1], 2.5 more
///   in    −log(density of the person's colours)                    (background_cut.h)
///   prior ±(4 at full reach): by the distance from the coarse mask's edge, inside up to 2 % of the mask's longer side,
///   outside
///         3 %; farther out than 6 % nothing is the person
///   c     the smaller of the picture's step between the neighbours and the step of its difference from the background:
///         an edge that the background has as well is none of the person
/// g is a gain a channel, the median of I/B outside: cameras follow the light. Where the background is not known, out
/// is half of −log(density of the colours around the person, 6 to 12 % of the mask's longer side away) and in is
/// halved. Pieces smaller than a tenth of the largest are left out. Shadows as in Horprasert et al., "A Statistical
/// Approach for Real-time Robust Background Subtraction and Shadow Detection", 1999; the background's own edges as in
/// Sun et al., "Background Cut", ECCV 2006.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/scene/label_image.h"
#include "render/image/image.h"
#include "tracking/detection/still_background.h"

namespace bodyloom {

// How often colours are seen, as a density over the cube of 256³ levels: a histogram of 16³ bins, a tenth of it spread
// evenly because not everything has been seen.

class ColourDensity {
 public:
  void Add(const uint8_t* bgr) { ++counts_[Bin(bgr)], ++total_; }
  /// Per level³, above 0; of nothing seen 1/256³ everywhere.
  [[nodiscard]] double At(const uint8_t* bgr) const {
    constexpr double kEven = 0.1, kLevels = 256.0 * 256 * 256;
    if (total_ == 0) return 1 / kLevels;
    return kEven / kLevels + (1 - kEven) * double(counts_[Bin(bgr)]) / double(total_) / 4096;
  }

 private:
  static int Bin(const uint8_t* bgr) { return (bgr[0] >> 4) << 8 | (bgr[1] >> 4) << 4 | bgr[2] >> 4; }
  std::vector<int64_t> counts_ = std::vector<int64_t>(4096, 0);
  int64_t total_ = 0;
};

/// None where more than a tenth of what lies around the person is farther than 4 σ from the background: the camera has
/// moved, or the light is another. `coarse` and `others` (other people's or everybody's, or empty; what `coarse` has
/// not is not this person's): width·height, not 0 where the person is. Returns 1 in the new mask's box; of an empty
/// coarse mask nothing.
/// Throws std::invalid_argument when sizes differ.
std::optional<LabelImage> CutFromBackground(const Image& picture, std::span<const uint8_t> coarse,
                                            std::span<const uint8_t> others, const StillBackground& background,
                                            const ColourDensity& person);

/// Adds what lies clearly inside of a coarse mask: deeper than 3 % of its longer side.
void AddClearInside(const Image& picture, std::span<const uint8_t> coarse, ColourDensity* person);

}  // namespace bodyloom
