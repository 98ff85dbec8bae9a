// SPDX-License-Identifier: Apache-2.0
/// Derivatives of a loss by the Gaussians of a picture (render/splat/splat_picture.h) from those by its pixels.
///
/// Each pixel is gone through front to back once more, with the same arithmetic, so it takes the Gaussians that it
/// took: the cut at 1/255, the limit of 0.99 and the stop are the picture's own. They are steps of the picture;
/// derivatives are those of what was drawn (a Gaussian that a pixel did not take gets nothing from it, one at the limit
/// nothing for its shape and opacity). With g, g_A the derivatives by colour and alpha, and `rest` = what lies behind:
///   rest = colour·g + alpha g_A;   for each Gaussian: w = T α,  k = c·g + g_A,  rest −= w k,
///   d loss/dα = T k − rest/(1 − α),   D = α d loss/dα
///   d loss/d mean = K [Σ D d_x, Σ D d_y],   d loss/dK = [−½ Σ D d_x², −Σ D d_x d_y, −½ Σ D d_y²],
///   d loss/d o = Σ D / o,   d loss/d c = Σ w g
///
/// Sums are taken tile by tile into a slot for every meeting of a Gaussian and a tile, then slot by slot in their
/// order: the same bytes for any number of threads and any instruction set.
#pragma once

#include <vector>

#include "geometry/math/arrays.h"
#include "render/splat/float_columns.h"
#include "render/splat/splat_picture.h"

namespace bodyloom {

/// Keeps its memory between pictures. Not for use by two threads at once.
class SplatGradient {
 public:
  /// `by_planes`: d loss / d plane, columns and rows as SplatPicture::planes() (over a background b, g_A takes −g·b).
  /// `picture` holds what it last drew of `screen`. The answer is one row a Gaussian, zero for one that was not drawn,
  /// with columns kMeanX to kBlue of ScreenGaussians. Throws std::invalid_argument for tables of other sizes, or fewer
  /// than one thread. Pixels whose derivatives are not finite spoil those of the Gaussians that they took.
  void Compute(const SplatPicture& picture, const ScreenGaussians& screen, const FloatColumns& by_planes,
               int num_threads, FloatColumns* by_screen);

 private:
  void GoThroughTile(const SplatPicture& picture, const FloatColumns& by_planes, int tile);
  void SumRows(const SplatPicture& picture, const ScreenGaussians& screen, int first, int last,
               FloatColumns* by_screen) const;

  AlignedFloats sums_;  ///< by slot
  size_t capacity_ = 0;
  std::vector<int> rank_of_;  ///< by row, −1: not drawn
};

}  // namespace bodyloom
