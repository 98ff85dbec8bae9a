// SPDX-License-Identifier: Apache-2.0
/// Loss between a rendered image of a person and the truth over a common background colour, with derivatives by the
/// image.
///
/// With premultiplied colours c and alphas α of the image, c' and α' of the truth, over the colour b:
///   p = c + (1 − α) b,   t = c' + (1 − α') b
///   loss = Σ over channels and pixels of the window of [0.8 |p − t| + 0.2 (1 − SSIM(p, t))] / (3 · 1.3 · person
///   pixels)
/// SSIM has a Gaussian window of σ 1.5 and 11 pixels a side, zero padding, and white is 1 (the preset 3dgs of
/// data_tools/evaluation/ssim.h). With a random b in each step the loss includes the person's outline, as b shows
/// through holes. At p = t the absolute value's derivative is 0.
///
/// Same bytes for any number of threads and any instruction set.
#pragma once

#include <array>

#include "render/splat/float_columns.h"

namespace bodyloom {

/// Ground truth of an image: rows are the window's pixels, row-major; columns red, green, blue (premultiplied, in [0,
/// 1]) and alpha.
struct ImageTruth {
  int width = 0, height = 0;
  FloatColumns planes;
  double person_pixels = 1;  ///< above 0
};

/// Keeps its memory between images. Not for use by two threads at once.
class ImageLoss {
 public:
  /// `image`: columns as ImageTruth::planes (those of SplatImage). Fills `by_planes` in the same layout and returns the
  /// loss. Throws std::invalid_argument when tables differ in size.
  double Compute(const FloatColumns& image, const ImageTruth& truth, const std::array<float, 3>& background,
                 int num_threads, FloatColumns* by_planes);

  /// |d loss / d p| of one channel of one pixel due to the absolute difference.
  static double ByPixel(const ImageTruth& truth);

 private:
  int width_ = 0, height_ = 0;
  size_t pitch_ = 0;         ///< floats from one row of the tables below to the next
  FloatColumns moments_;     ///< filtered along rows, one column per channel and moment (3 × 4)
  FloatColumns by_moments_;  ///< likewise, 3 × 3 derivatives
  std::array<float, 6> half_{};
};

}  // namespace bodyloom
