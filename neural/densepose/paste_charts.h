// SPDX-License-Identifier: Apache-2.0
/// Resamples DensePose's planes of one person to the pixels of its box.
///
/// The planes are a grid of h × w cells over the box [x0, x1] × [y0, y1]. Pixel (x, y), whose centre is (x+½, y+½) in
/// the box's coordinates, lies at column (x + ½ − x0)·w/(x1 − x0) − ½ of the grid, rows likewise; all planes are
/// interpolated there bilinearly, with border cells replicated. With the interpolated logits
///   part = argmax(fine) where argmax(coarse) > 0, otherwise 0 (background),
/// and (u, v) is from the part's planes, clamped to [0, 1]. Of equal logits the first wins. DensePose's reference code
/// truncates the box to whole pixels first, which shifts the labels by up to one pixel; otherwise the rule is the same
/// (detectron2, projects/DensePose, converters/to_chart_result.py).
#pragma once

#include "geometry/scene/label_image.h"

namespace bodyloom {

/// Planes in C order, channel by channel.
struct ChartPlanes {
  static constexpr int kFine = 25;  ///< background and the 24 charts
  int coarse_channels = 2;          ///< background first; 2, or 15 for networks that distinguish body parts
  int height = 0, width = 0;
  const float *coarse = nullptr, *fine = nullptr, *u = nullptr, *v = nullptr;
};

/// Resamples to the pixels of an image of this size whose centres lie in `box`; none when the box is empty, not finite
/// or outside. Pixels whose interpolated u or v is not finite are background. Throws std::invalid_argument for planes
/// without cells.
ChartImage PasteCharts(const ChartPlanes& planes, const ChartDetection& box, int image_width, int image_height);

}  // namespace bodyloom
