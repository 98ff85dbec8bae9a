// SPDX-License-Identifier: Apache-2.0
/// The parts of one frame's label image, without specks, as input of PartLabelMatches.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/scene/observations.h"
#include "render/image/pixel_box.h"

namespace bodyloom {

struct PartMap {
  PixelBox image, box;         ///< of the whole image, and of the pixels that are held; those between are background
  std::vector<uint8_t> parts;  ///< of the box, row-major

  /// Unknown beyond the image.
  [[nodiscard]] uint8_t At(int x, int y) const {
    if (box.Contains(x, y)) return parts[box.IndexOf(x, y)];
    return image.Contains(x, y) ? PartLabelSequence::kBackground : PartLabelSequence::kUnknown;
  }
  /// At() of the pixels (x_begin, y) to (x_end − 1, y).
  void ReadRow(int y, int x_begin, int x_end, uint8_t* row) const;
};

/// True if `part` is neither background nor unknown.
inline bool IsPart(uint8_t part) {
  return part != PartLabelSequence::kBackground && part != PartLabelSequence::kUnknown;
}

/// Frame t of the labels. Specks become unknown: 4-connected pieces of the person smaller than `speck_share` of its
/// largest piece, then pieces of a part smaller than that share of the part's largest piece. Detectors leave such
/// pieces on furniture and at the seams between parts.
PartMap MakePartMap(const PartLabelSequence& labels, int t, double speck_share);

}  // namespace bodyloom
