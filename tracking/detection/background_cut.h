// SPDX-License-Identifier: Apache-2.0
/// Refines a person's mask by a graph cut against the known background. A network's mask includes objects and light
/// beside the person, and its outline is off by some pixels.
///
/// The cut minimises Σ_pixels unary + Σ_neighbours λ e^(−c²/2β) [one in, one out] over masks, β the mean of c² over the
/// window:
///   out   −log(0.99 N(I; gB, σ) + 1/256³/100), or darker by a shadow: the nearest sB with s in [0.55, 1], 2.5 more
///   in    −log(density of the person's colours)                    (ColourDensity)
///   prior linear in the distance from the coarse mask's edge, up to ±4 at 2 % of the mask's longer side inside and 3 %
///         outside; pixels farther out than 6 % are not the person
///   c     the smaller of the image's step between the neighbours and the step of its difference from the background:
///         an edge that the background has as well does not belong to the person
/// g is a gain per channel, the median of I/B outside the mask, since cameras adapt their exposure. Where the
/// background is not known, out is half of −log(density of the colours around the person, 6 to 12 % of the mask's
/// longer side away) and in is halved. Pieces smaller than a tenth of the largest are dropped. Shadows as in
/// Horprasert et al., "A Statistical Approach for Real-time Robust Background Subtraction and Shadow Detection", 1999;
/// the background's own edges as in Sun et al., "Background Cut", ECCV 2006.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/scene/label_image.h"
#include "render/image/image.h"
#include "tracking/detection/still_background.h"

namespace bodyloom {

/// Density of colours over the cube of 256³ levels: a histogram of 16³ bins, a tenth of it spread evenly because the
/// samples do not show every colour.
class ColourDensity {
 public:
  void Add(const uint8_t* bgr) { ++counts_[Bin(bgr)], ++total_; }
  /// Density per level³, above 0; 1/256³ everywhere before the first Add().
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

/// Returns the refined mask, 1 for the person in its box; empty for an empty coarse mask. None when more than a tenth
/// of the pixels around the person are farther than 4 σ from the background: the camera or the light has changed.
/// `coarse` and `others` (masks of other people or of everybody, or empty; pixels outside `coarse` are not this
/// person's): width·height, not 0 where the person is. Throws std::invalid_argument when sizes differ.
std::optional<LabelImage> CutFromBackground(const Image& image, std::span<const uint8_t> coarse,
                                            std::span<const uint8_t> others, const StillBackground& background,
                                            const ColourDensity& person);

/// Adds the colours of the pixels clearly inside a coarse mask: deeper than 3 % of its longer side.
void AddClearInside(const Image& image, std::span<const uint8_t> coarse, ColourDensity* person);

}  // namespace bodyloom
