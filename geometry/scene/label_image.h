// SPDX-License-Identifier: Apache-2.0
/// A label of every pixel of a rectangle, as a picture and packed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bodyloom {

/// A detector's label of every pixel of a rectangle of the image. Pixels outside the rectangle are background.
struct LabelImage {
  int x_begin = 0, y_begin = 0, width = 0, height = 0;  ///< pixels; negative or empty sizes hold nothing
  std::vector<uint8_t> labels;                          ///< width·height, row-major
  [[nodiscard]] uint8_t At(int x, int y) const {
    if (x < x_begin || y < y_begin || x >= x_begin + width || y >= y_begin + height) return 0;
    return labels[size_t(y - y_begin) * size_t(width) + size_t(x - x_begin)];
  }
  /// The labels of a whole image, row-major.
  [[nodiscard]] std::vector<uint8_t> Over(int image_width, int image_height) const;
};

/// The same as runs of equal labels, row after row: what a clip holds thousands of. A mask of a person who is 900
/// pixels high takes some 20 KB in the place of 400, and a fifth of a millisecond to pack or unpack.
class PackedLabels {
 public:
  PackedLabels() = default;
  /// Whatever the image is, also one whose labels are not as many as its rectangle has pixels: Unpacked() gives it
  /// back.
  PackedLabels(const LabelImage& image);  // NOLINT(google-explicit-constructor): a picture in a sequence of them

  [[nodiscard]] LabelImage Unpacked() const;
  /// LabelImage::At() of it, in logarithmic time; whoever wants most of the pixels unpacks.
  [[nodiscard]] uint8_t At(int x, int y) const;
  /// Holds no label.
  [[nodiscard]] bool empty() const { return ends_.empty(); }

 private:
  int x_begin_ = 0, y_begin_ = 0, width_ = 0, height_ = 0;
  std::vector<uint32_t> ends_;  ///< of the runs, pixels from the first
  std::vector<uint8_t> labels_;
};

// What of the body's surface the pixels of an image show, as dense detectors say it: a chart and the place in it.

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
