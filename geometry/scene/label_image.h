// SPDX-License-Identifier: Apache-2.0
/// Label images: one label per pixel of a rectangle, plain and run-length encoded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bodyloom {

/// A detector's label of every pixel of a rectangle of the image. Pixels outside the rectangle are background.
struct LabelImage {
  int x_begin = 0, y_begin = 0, width = 0, height = 0;  ///< pixels; with a size of 0 or less it is empty
  std::vector<uint8_t> labels;                          ///< width·height, row-major
  [[nodiscard]] uint8_t At(int x, int y) const {
    if (x < x_begin || y < y_begin || x >= x_begin + width || y >= y_begin + height) return 0;
    return labels[size_t(y - y_begin) * size_t(width) + size_t(x - x_begin)];
  }
  /// Returns the labels of a whole image, row-major.
  [[nodiscard]] std::vector<uint8_t> Over(int image_width, int image_height) const;
};

/// A LabelImage as runs of equal labels, row by row, as clips hold thousands of them. A mask of a person 900 pixels
/// tall takes about 20 KB instead of 400, and 0.2 ms to pack or unpack.
class PackedLabels {
 public:
  PackedLabels() = default;
  /// Accepts any image, also one whose number of labels differs from its rectangle's pixels; Unpacked() restores it.
  PackedLabels(const LabelImage& image);  // NOLINT(google-explicit-constructor): a frame of a sequence

  [[nodiscard]] LabelImage Unpacked() const;
  /// Same as LabelImage::At(), in logarithmic time; to read most of the pixels, unpack.
  [[nodiscard]] uint8_t At(int x, int y) const;
  /// True if there are no labels.
  [[nodiscard]] bool empty() const { return ends_.empty(); }

 private:
  int x_begin_ = 0, y_begin_ = 0, width_ = 0, height_ = 0;
  std::vector<uint32_t> ends_;  ///< ends of the runs, counted in pixels from the first
  std::vector<uint8_t> labels_;
};

// Outputs of dense detectors: for each pixel, a chart of the body's surface and coordinates in it.

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
