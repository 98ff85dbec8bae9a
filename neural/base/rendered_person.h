// SPDX-License-Identifier: Apache-2.0
/// A person rendered from photos. A header of its own, so that the renderers' headers do not include metrics.
#pragma once

#include <cstdint>
#include <vector>

namespace bodyloom {

/// Planar, size × size.
struct RenderedPerson {
  int size = 0;
  std::vector<float> image;     ///< 3, RGB in [0, 1] multiplied by alpha
  std::vector<float> alpha;     ///< 1, share of the pixel that the person covers
  std::vector<uint8_t> labels;  ///< garment labels; 0 where alpha is below ½; empty: not rendered
};

}  // namespace bodyloom
