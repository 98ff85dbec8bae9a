// SPDX-License-Identifier: Apache-2.0
/// Maps errors on a surface or per pixel to colours, and draws the legend.
///
/// The colours are viridis (van der Walt and Smith, matplotlib 2.0): dark violet at error 0, through blue and green to
/// yellow at the maximum and above. It is perceptually uniform (CIELAB lightness is linear in the error), also in grey
/// and for colour-blind viewers.
#pragma once

#include <string>

#include "render/image/image.h"

namespace bodyloom {

/// Scale of the error colours in a picture.
struct ErrorScale {
  double maximum = 1;  ///< yellow at and above this
  std::string unit;    ///< "mm", "px", "grey levels"
  std::string what;    ///< "vertex error": start of the legend

  /// "vertex error: violet 0, yellow 50 mm and more".
  [[nodiscard]] std::string ToText() const;
};

/// The colour of the error share·maximum; shares are clamped to 0..1, NaN (not known) is grey.
Colour ErrorColour(double share);

/// Draws the legend: `scale.what`, a bar of all colours, and below it 0, half of the maximum and the maximum with the
/// unit, on a translucent panel of about `width` pixels. `cap_px`: height of its letters.
void DrawErrorLegend(const ErrorScale& scale, int x, int y, int width, double cap_px, Image* image);
/// Height of that panel.
int ErrorLegendHeight(double cap_px);

}  // namespace bodyloom
