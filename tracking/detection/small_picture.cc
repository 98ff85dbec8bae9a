// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/small_picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace bodyloom {
namespace {

constexpr double kAroundMask = 0.04;

}  // namespace

SmallPicture SmallPicture::Of(int frame_width, int frame_height, int longer_side) {
  SmallPicture size;
  size.scale = std::max(1.0, std::max(frame_width, frame_height) / double(longer_side));
  size.width = std::max(1, static_cast<int>(std::lround(frame_width / size.scale)));
  size.height = std::max(1, static_cast<int>(std::lround(frame_height / size.scale)));
  return size;
}

SmallPicture SmallPicture::ByWholeScale(int frame_width, int frame_height, int longer_side) {
  SmallPicture size;
  size.scale = std::ceil(std::max(1.0, std::max(frame_width, frame_height) / double(longer_side)));
  size.width = std::max(1, static_cast<int>(frame_width / size.scale));
  size.height = std::max(1, static_cast<int>(frame_height / size.scale));
  return size;
}

std::vector<uint8_t> ShrunkGrey(const Image& frame, const SmallPicture& size) {
  std::vector<uint8_t> pixels(size.num_pixels());
  // OpenCV does not write to a matrix that it only reads.
  const cv::Mat colours(frame.height, frame.width, CV_8UC3, const_cast<uint8_t*>(frame.bgr.data()));
  cv::Mat grey(size.height, size.width, CV_8UC1, pixels.data());
  if (size.scale == 1) {
    cv::cvtColor(colours, grey, cv::COLOR_BGR2GRAY);
    return pixels;
  }
  const int columns = static_cast<int>(size.scale * size.width), rows = static_cast<int>(size.scale * size.height);
  if (size.scale == std::floor(size.scale) && columns <= frame.width && rows <= frame.height) {
    cv::Mat all;
    cv::cvtColor(colours(cv::Rect(0, 0, columns, rows)), all, cv::COLOR_BGR2GRAY);
    cv::resize(all, grey, grey.size(), 0, 0, cv::INTER_AREA);
    return pixels;
  }
  cv::Mat small;
  cv::resize(colours, small, grey.size(), 0, 0, cv::INTER_AREA);
  cv::cvtColor(small, grey, cv::COLOR_BGR2GRAY);
  return pixels;
}

void CoverBox(double x0, double y0, double x1, double y1, const SmallPicture& size, CoveredPixels* covered) {
  covered->resize(size.num_pixels(), 0);
  if (!(std::isfinite(x0) && std::isfinite(x1) && std::isfinite(y0) && std::isfinite(y1))) return;
  const auto small = [&](double v, int limit) {
    return static_cast<int>(std::lround(std::clamp((v + 0.5) / size.scale, 0.0, double(limit))));
  };
  const int left = small(std::min(x0, x1), size.width), right = small(std::max(x0, x1), size.width);
  for (int y = small(std::min(y0, y1), size.height); y < small(std::max(y0, y1), size.height); ++y) {
    std::fill_n(covered->begin() + std::ptrdiff_t(y) * size.width + left, right - left, uint8_t{1});
  }
}

void CoverMask(const LabelImage& mask, const SmallPicture& size, CoveredPixels* covered) {
  covered->resize(size.num_pixels(), 0);
  cv::Mat inside(size.height, size.width, CV_8UC1, cv::Scalar(0)), wide;
  const auto frame_pixel = [&](int v) { return static_cast<int>(std::lround(size.scale * (v + 0.5) - 0.5)); };
  for (int y = 0; y < size.height; ++y) {
    const int row = frame_pixel(y);
    if (row < mask.y_begin || row >= mask.y_begin + mask.height) continue;
    for (int x = 0; x < size.width; ++x) inside.at<uint8_t>(y, x) = mask.At(frame_pixel(x), row) != 0 ? 1 : 0;
  }
  const int margin = 1 + static_cast<int>(kAroundMask * std::max(mask.width, mask.height) / size.scale);
  cv::dilate(inside, wide, cv::getStructuringElement(cv::MORPH_RECT, {2 * margin + 1, 2 * margin + 1}));
  cv::Mat all(size.height, size.width, CV_8UC1, covered->data());
  all |= wide;
}

}  // namespace bodyloom
