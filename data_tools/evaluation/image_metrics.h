// SPDX-License-Identifier: Apache-2.0
/// Metrics of two images: PSNR, overlap of masks and labels, angle between normals. (SSIM: ssim.h.)
///
/// All are computed in double, on images of equal size (else std::invalid_argument with both sizes). NaN if there was
/// nothing to measure: no pixel in the mask, or a mask or label absent from both images.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "render/image/image.h"

namespace bodyloom {

/// A set of pixels in row order: 0 outside, any other value inside.
struct PixelMask {
  int width = 0, height = 0;
  std::vector<uint8_t> inside;
};

/// A pixel is inside where a channel is 128 or more.
PixelMask MaskFrom(const Image& image);

/// The band around the contour: pixels with a pixel inside and one outside `mask` within `pixels` columns and rows.
/// Beyond the image border counts as neither.
PixelMask RimOf(const PixelMask& mask, int pixels);

/// Channels one after the other, each width×height values in rows from the top. Values of any range.
struct PlanarImage {
  int width = 0, height = 0, channels = 0;
  std::vector<double> values;
  [[nodiscard]] std::span<const double> plane(int channel) const {
    const size_t n = static_cast<size_t>(width) * height;
    return {values.data() + channel * n, n};
  }
};

/// Red, green, blue in 0..255.
PlanarImage PlanarFrom(const Image& image);

/// 10 log10(range² / MSE) dB, MSE the mean of squared differences over all channels of the pixels in `mask` (nullptr:
/// of the whole image). +inf for equal images, NaN for an empty mask or non-finite values.
double Psnr(const PlanarImage& truth, const PlanarImage& result, double data_range, const PixelMask* mask = nullptr);
/// The same on bytes, range 255.
double Psnr(const Image& truth, const Image& result, const PixelMask* mask = nullptr);

/// |A ∩ B| / |A ∪ B|; NaN when both are empty.
double MaskIoU(const PixelMask& truth, const PixelMask& result);

struct LabelOverlap {
  std::vector<double> iou;  ///< by label: |A ∩ B| / |A ∪ B|; NaN where neither image has the label
  double mean_iou = std::numeric_limits<double>::quiet_NaN();  ///< over the labels of either image
  double accuracy = std::numeric_limits<double>::quiet_NaN();  ///< share of pixels with the right label
};

/// Labels 0..num_labels−1, pixel by pixel; throws std::invalid_argument for labels out of range or different lengths.
LabelOverlap CompareLabels(std::span<const uint8_t> truth, std::span<const uint8_t> result, int num_labels);

struct NormalError {
  double mean_deg = std::numeric_limits<double>::quiet_NaN();
  double median_deg = std::numeric_limits<double>::quiet_NaN();  ///< the mean of the middle two of an even number
  /// Share of the truth's normals where the result has one too; errors are over these alone.
  double coverage = std::numeric_limits<double>::quiet_NaN();
};

/// Angle atan2(|a×b|, a·b) between normals n = 2c/255 − 1 of (red, green, blue). A pixel has a normal when its vector's
/// length is within [0.5, 1.5], which leaves out the backgrounds in use: black (length 1.73) and mid-grey (0.01).
/// Pixels outside `mask` (nullptr: none) are ignored. 8 bits resolve about 0.3°.
NormalError CompareNormals(const Image& truth, const Image& result, const PixelMask* mask = nullptr);

}  // namespace bodyloom
