// SPDX-License-Identifier: Apache-2.0
/// Errors as colours: how far something is off, on a surface or pixel by pixel, with the legend that says so.
///
/// The colours are viridis (van der Walt and Smith, matplotlib 2.0): dark violet where the error is 0, over blue and
/// green to yellow at the maximum and above. Equal steps of the error look like equal steps (CIELAB lightness rises in
/// a straight line), also in grey and to people who do not tell red from green.
#pragma once

#include <string>

#include "render/image/image.h"

namespace bodyloom {

/// What the colours of a picture mean.
struct ErrorScale {
  double maximum = 1;  ///< yellow from here on
  std::string unit;    ///< "mm", "px", "grey levels"
  std::string what;    ///< "vertex error": begins the legend

  /// "vertex error: violet 0, yellow 50 mm and more".
  [[nodiscard]] std::string ToText() const;
};

/// The colour of share·maximum; shares beyond 0..1 take the ends', NaN (not known) is grey.
Colour ErrorColour(double share);

/// The legend: `scale.what`, a bar of all colours, and below it 0, half of the maximum and the maximum with the unit,
/// on a translucent panel of about `width` pixels. `cap_px`: height of its letters.
void DrawErrorLegend(const ErrorScale& scale, int x, int y, int width, double cap_px, Image* image);
/// Height of that panel.
int ErrorLegendHeight(double cap_px);

}  // namespace bodyloom
