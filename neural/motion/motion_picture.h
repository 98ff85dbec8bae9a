// SPDX-License-Identifier: Apache-2.0
/// A picture rendered by the motion-dependent renderer.
#pragma once

#include <cstdint>
#include <vector>

namespace bodyloom {

/// Planar, window size.
struct MotionPicture {
  int width = 0, height = 0;
  std::vector<float> image;     ///< 3, RGB in [0, 1], 0 on the background
  std::vector<float> alpha;     ///< 1, probability of the foreground (1 throughout without the shape decoder)
  std::vector<float> normals;   ///< 3, camera frame, shortened by alpha; empty without normals
  std::vector<uint8_t> labels;  ///< likeliest class; empty without the shape decoder
};

}  // namespace bodyloom
