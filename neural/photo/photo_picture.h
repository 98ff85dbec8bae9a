// SPDX-License-Identifier: Apache-2.0
/// A picture rendered by the one-photo renderer.
#pragma once

#include <vector>

namespace bodyloom {

/// Planar, of the whole frame.
struct PhotoPicture {
  int size = 0;
  std::vector<float> image;  ///< 3 × S × S RGB in [0, 1], multiplied by alpha
  std::vector<float> alpha;  ///< S × S, how much of a pixel the person covers
};

}  // namespace bodyloom
