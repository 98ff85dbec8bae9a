// SPDX-License-Identifier: Apache-2.0
#include "render/image/image.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "geometry/base/check.h"
#include "render/image/image_mat.h"

namespace bodyloom {

Image::Image(int width_px, int height_px, Colour fill) : width(width_px), height(height_px) {
  BODYLOOM_CHECK(width >= 0 && height >= 0, "image size ", width, "x", height, " is negative");
  bgr.resize(3 * size_t(width) * height);
  for (size_t i = 0; i < bgr.size(); i += 3) bgr[i] = fill.blue, bgr[i + 1] = fill.green, bgr[i + 2] = fill.red;
}

Image StudioBackdrop(int width, int height) {
  Image image(width, height);
  const double radius2 = (double(width) * width + double(height) * height) / 4;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double dx = x - (width - 1) / 2.0, dy = y - 0.42 * (height - 1);
      const double light = 1 - 0.42 * (dx * dx + dy * dy) / radius2;
      // Ordered dither of one grey level: a smooth ramp without bands.
      const double dither = ((x * 5 + y * 3) % 8) / 8.0;
      uint8_t* p = image.pixel(x, y);
      p[0] = static_cast<uint8_t>(236 * light + dither);
      p[1] = static_cast<uint8_t>(231 * light + dither);
      p[2] = static_cast<uint8_t>(226 * light + dither);
    }
  }
  return image;
}

Image Resized(const Image& image, int width, int height) {
  BODYLOOM_CHECK(!image.empty() && width > 0 && height > 0, "cannot resize ", image.width, "x", image.height, " to ",
                 width, "x", height);
  Image result(width, height);
  cv::Mat target = MatOf(&result);
  const bool shrinks = width < image.width || height < image.height;
  cv::resize(MatOf(image), target, target.size(), 0, 0, shrinks ? cv::INTER_AREA : cv::INTER_CUBIC);
  return result;
}

void Paste(const Image& source, int x, int y, Image* target) {
  const int x_begin = std::max(0, -x), x_end = std::min(source.width, target->width - x);
  for (int row = std::max(0, -y); row < std::min(source.height, target->height - y) && x_begin < x_end; ++row) {
    std::copy_n(source.pixel(x_begin, row), 3 * (x_end - x_begin), target->pixel(x + x_begin, y + row));
  }
}

}  // namespace bodyloom
