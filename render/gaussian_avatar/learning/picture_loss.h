// SPDX-License-Identifier: Apache-2.0
/// How far a picture of a person is from the truth, and the derivatives by the picture, over a colour put behind both.
///
/// With premultiplied colours c and alphas of the picture and c', α' of the truth, over the colour b:
///   p = c + (1 − α) b,   t = c' + (1 − α') b
///   loss = Σ over channels and pixels of the window of [0.8 |p − t| + 0.2 (1 − SSIM(p, t))] / (3 · 1.3 · person
///   pixels)
/// SSIM by a Gaussian window of σ 1.5 and 11 pixels a side, zeros around the window, white is 1 (the preset 3dgs of
/// data_tools/evaluation/ssim.h). Where b is drawn anew each step the person's outline is part of the loss: a hole
/// shows b, and so does what should be a hole. At p = t the absolute value's derivative is 0.
///
/// Same bytes for any number of threads and any instruction set.
#pragma once

#include <array>

#include "render/splat/float_columns.h"

namespace bodyloom {

/// What a picture is compared with: rows are the window's pixels, row-major; columns red, green, blue (premultiplied,
/// in [0, 1]) and alpha.
struct PictureTruth {
  int width = 0, height = 0;
  FloatColumns planes;
  double person_pixels = 1;  ///< above 0
};

/// Keeps its memory between pictures. Not for use by two threads at once.
class PictureLoss {
 public:
  /// `picture`: columns as PictureTruth::planes (those of SplatPicture). Fills `by_planes` alike and returns the loss.
  /// Throws std::invalid_argument when tables differ in size.
  double Compute(const FloatColumns& picture, const PictureTruth& truth, const std::array<float, 3>& background,
                 int num_threads, FloatColumns* by_planes);

  /// |d loss / d p| of a channel of one pixel that the absolute difference has.
  static double ByPixel(const PictureTruth& truth);

 private:
  int width_ = 0, height_ = 0;
  size_t pitch_ = 0;         ///< floats from one row of the below to the next
  FloatColumns moments_;     ///< filtered along rows, a column for each of 3 channels × 4 moments
  FloatColumns by_moments_;  ///< the same of 3 × 3 derivatives
  std::array<float, 6> half_{};
};

}  // namespace bodyloom
