// SPDX-License-Identifier: Apache-2.0
/// A person as a renderer drew it from photos; of its own, so that the renderers' headers need no metrics.
#pragma once

#include <cstdint>
#include <vector>

namespace bodyloom {

/// Planar, size × size.
struct PersonPicture {
  int size = 0;
  std::vector<float> image;     ///< 3, RGB in [0, 1] multiplied by alpha
  std::vector<float> alpha;     ///< 1, how much of a pixel the person covers
  std::vector<uint8_t> labels;  ///< garment labels; 0 where alpha is below ½; empty: the renderer draws none
};

}  // namespace bodyloom
