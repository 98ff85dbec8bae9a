// SPDX-License-Identifier: Apache-2.0
/// A picture that the pose-guided renderer made, and what it was given to begin with. Planar, size × size.
#pragma once

#include <cstdint>
#include <vector>

namespace bodyloom {

struct GuidedPicture {
  int size = 0;
  std::vector<float> image;     ///< 3, RGB in [0, 1] multiplied by alpha
  std::vector<float> alpha;     ///< 1, the silhouette
  std::vector<uint8_t> labels;  ///< garment labels; 0 where alpha is below ½
};

/// G̃, Ĩ, S̃: what is known of a pose before anything is completed.
struct PseudoPicture {
  int size = 0;
  std::vector<float> image;     ///< 3; 0 where nothing is known
  std::vector<uint8_t> labels;  ///< 0 where nothing is known
  std::vector<uint8_t> known;   ///< S̃
  std::vector<float> extent;    ///< how far clothes stand off the body (clothes_extent.h); empty: nobody knows
  std::vector<float> clothed;   ///< the body as far as clothes would stand off; empty as well
};

}  // namespace bodyloom
