// SPDX-License-Identifier: Apache-2.0
/// DensePose's planes of one person, laid over the pixels of its box.
///
/// The planes are a grid of h × w cells over the box [x0, x1] × [y0, y1]. Pixel (x, y), whose centre is (x+½, y+½) in
/// the box's coordinates, lies at column (x + ½ − x0)·w/(x1 − x0) − ½ of the grid and the row alike; all planes are
/// interpolated there bilinearly, with the border's cells beyond the border. Of the interpolated logits
///   part = argmax(fine) where argmax(coarse) > 0, otherwise 0 (background),
/// and (u, v) is that of the part's own planes, clamped to [0, 1]. Of equal logits the first wins. DensePose's own
/// program truncates the box to whole pixels first, which moves the labels by up to one; otherwise this is its rule
/// (detectron2, projects/DensePose, converters/to_chart_result.py).
#pragma once

#include "geometry/scene/label_image.h"

namespace bodyloom {

/// Planes in C order, channel by channel.
struct ChartPlanes {
  static constexpr int kFine = 25;  ///< background and the 24 charts
  int coarse_channels = 2;          ///< background first; 2, or 15 of networks that tell body parts apart
  int height = 0, width = 0;
  const float *coarse = nullptr, *fine = nullptr, *u = nullptr, *v = nullptr;
};

/// The pixels of an image of this size whose centres lie in `box`; none when the box is empty, not finite or elsewhere.
/// Pixels whose interpolated u or v is not finite are background. Throws std::invalid_argument for planes without
/// cells.
ChartImage PasteCharts(const ChartPlanes& planes, const ChartDetection& box, int image_width, int image_height);

}  // namespace bodyloom
