// SPDX-License-Identifier: Apache-2.0
/// Backpropagates derivatives of a loss from the pixels of a rendered image (render/splat/splat_image.h) to its
/// Gaussians.
///
/// Each pixel is traversed front to back again with the same arithmetic, so that it uses the Gaussians that it used in
/// the forward pass: the cut at 1/255, the limit of 0.99 and the stop are the same. The derivatives of these
/// discontinuities are ignored (a Gaussian that a pixel did not use gets none from it, one at the limit none for shape
/// and opacity). With g, g_A the derivatives by colour and alpha, and `rest` the contribution of what lies behind:
///   rest = colour·g + alpha g_A;   for each Gaussian: w = T α,  k = c·g + g_A,  rest −= w k,
///   d loss/dα = T k − rest/(1 − α),   D = α d loss/dα
///   d loss/d mean = K [Σ D d_x, Σ D d_y],   d loss/dK = [−½ Σ D d_x², −Σ D d_x d_y, −½ Σ D d_y²],
///   d loss/d o = Σ D / o,   d loss/d c = Σ w g
///
/// Sums are accumulated per tile into one slot per pair of Gaussian and tile, then over slots in fixed order: the same
/// bytes for any number of threads and any instruction set.
#pragma once

#include <vector>

#include "geometry/math/arrays.h"
#include "render/splat/float_columns.h"
#include "render/splat/splat_image.h"

namespace bodyloom {

/// Keeps its memory between images. Not for use by two threads at once.
class SplatGradient {
 public:
  /// `by_planes`: d loss / d plane, columns and rows as SplatImage::planes() (over a background b, g_A takes −g·b).
  /// `image` was last drawn from `screen`. `by_screen` receives one row per Gaussian with columns kMeanX to kBlue of
  /// ScreenGaussians, zero if it was not drawn. Throws std::invalid_argument for tables of other sizes, or fewer than
  /// one thread. Pixels with derivatives that are not finite make those of their Gaussians not finite.
  void Compute(const SplatImage& image, const ScreenGaussians& screen, const FloatColumns& by_planes, int num_threads,
               FloatColumns* by_screen);

 private:
  void GoThroughTile(const SplatImage& image, const FloatColumns& by_planes, int tile);
  void SumRows(const SplatImage& image, const ScreenGaussians& screen, int first, int last,
               FloatColumns* by_screen) const;

  AlignedFloats sums_;  ///< by slot
  size_t capacity_ = 0;
  std::vector<int> rank_of_;  ///< by row, −1: not drawn
};

}  // namespace bodyloom
