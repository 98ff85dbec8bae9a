// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/image_crop.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "geometry/base/check.h"
#include "render/image/image_mat.h"

namespace bodyloom {
namespace {

constexpr double kBoxPadding = 1.25;
constexpr uint8_t kBorder = 114;
constexpr std::array<float, 3> kMean = {123.675F, 116.28F, 103.53F}, kDeviation = {58.395F, 57.12F, 57.375F};

/// An image's bytes as planes of red, green, blue: (value − mean) / deviation.
std::vector<float> Planes(const cv::Mat& bgr, const std::array<float, 3>& mean, const std::array<float, 3>& deviation) {
  const size_t pixels = bgr.total();
  std::vector<float> planes(3 * pixels);
  float* to = planes.data();
  for (int row = 0; row < bgr.rows; ++row) {
    const uint8_t* from = bgr.ptr<uint8_t>(row);
    for (int column = 0; column < bgr.cols; ++column, ++to, from += 3) {
      for (size_t c = 0; c < 3; ++c) to[c * pixels] = (float(from[2 - c]) - mean[c]) / deviation[c];
    }
  }
  return planes;
}

}  // namespace

ImageCrop LetterboxCrop(int image_width, int image_height, int width, int height) {
  BODYLOOM_CHECK(std::min({image_width, image_height, width, height}) >= 1, "a letterbox of ", width, "x", height,
                 " for an image of ", image_width, "x", image_height);
  const double gain = std::min(double(width) / image_width, double(height) / image_height);
  ImageCrop crop{.width = width, .height = height};
  crop.gain = {gain, gain};
  // Half a pixel of border goes to the right and below.
  crop.shift = {std::round((width - std::round(image_width * gain)) / 2 - 0.1),
                std::round((height - std::round(image_height * gain)) / 2 - 0.1)};
  return crop;
}

std::vector<float> LetterboxPixels(const Image& image, const ImageCrop& crop) {
  cv::Mat filled(crop.height, crop.width, CV_8UC3, cv::Scalar::all(kBorder));
  const cv::Size size(std::max(1, int(std::round(image.width * crop.gain.x()))),
                      std::max(1, int(std::round(image.height * crop.gain.y()))));
  const cv::Rect place(cv::Point(int(crop.shift.x()), int(crop.shift.y())), size);
  cv::Mat inside = filled(place);
  if (size == cv::Size(image.width, image.height)) {
    MatOf(image).copyTo(inside);
  } else {
    cv::resize(MatOf(image), inside, size, 0, 0, cv::INTER_LINEAR);
  }
  return Planes(filled, {0, 0, 0}, {255, 255, 255});
}

ImageCrop TopDownCrop(const PersonBox& box, int width, int height) {
  const Eigen::Array2d low(box.x0, box.y0), high(box.x1, box.y1);
  BODYLOOM_CHECK(low.allFinite() && high.allFinite() && (high > low).all(), "a box from ", box.x0, ", ", box.y0, " to ",
                 box.x1, ", ", box.y1);
  Eigen::Array2d size = kBoxPadding * (high - low);
  const double aspect = double(width) / height;
  if (size.x() > size.y() * aspect) {
    size.y() = size.x() / aspect;
  } else {
    size.x() = size.y() * aspect;
  }
  ImageCrop crop{.width = width, .height = height};
  const Eigen::Array2d pixels(width, height);
  crop.gain = pixels / size;
  crop.shift = pixels / 2 - crop.gain * (low + high) / 2;
  return crop;
}

std::vector<float> TopDownPixels(const Image& image, const ImageCrop& crop) {
  const cv::Matx23d crop_from_image(crop.gain.x(), 0, crop.shift.x(), 0, crop.gain.y(), crop.shift.y());
  cv::Mat pixels;
  cv::warpAffine(MatOf(image), pixels, crop_from_image, {crop.width, crop.height}, cv::INTER_LINEAR,
                 cv::BORDER_CONSTANT, cv::Scalar::all(0));
  return Planes(pixels, kMean, kDeviation);
}

}  // namespace bodyloom
