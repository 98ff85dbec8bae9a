// SPDX-License-Identifier: Apache-2.0
/// What of the body's surface the pixels of an image show, as dense detectors say it: a chart and the place in it.
#pragma once

#include <cstdint>
#include <vector>

namespace bodyloom {

/// The labels of a rectangle of an image; pixels outside it are background. Rows from top to bottom.
struct ChartImage {
  int x_begin = 0, y_begin = 0, width = 0, height = 0;  ///< pixels
  std::vector<uint8_t> part;                            ///< chart 1..24, 0: background
  std::vector<float> u, v;                              ///< in [0, 1] where there is a part
};

/// One person that a dense detector found.
struct ChartDetection {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< box, pixel edges: the whole image is [0, width] × [0, height]
  double score = 1;                       ///< in [0, 1]; 1 where the detector gives none
  ChartImage charts;
};

}  // namespace bodyloom
