// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/datasets/nearest_pixel.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

std::vector<int> NearestMarked(std::span<const uint8_t> marked, int width, int height) {
  const size_t area = size_t(width) * height;
  BODYLOOM_CHECK(width > 0 && height > 0 && marked.size() == area, "nearest pixel: ", marked.size(),
                 " pixels, expected ", width, "x", height);
  std::vector<int> result(area, -1);
  if (std::all_of(marked.begin(), marked.end(), [](uint8_t value) { return value == 0; })) return result;
  // OpenCV numbers the zeros of the picture it is given, and says of every pixel which is nearest.
  cv::Mat unmarked(height, width, CV_8UC1), distance, nearest;
  for (size_t i = 0; i < area; ++i) unmarked.data[i] = marked[i] != 0 ? 0 : 255;
  cv::distanceTransform(unmarked, distance, nearest, cv::DIST_L2, cv::DIST_MASK_5, cv::DIST_LABEL_PIXEL);
  std::vector<int> pixel_of_number(area + 1, -1);
  const int* number = nearest.ptr<int>();
  for (size_t i = 0; i < area; ++i) {
    if (marked[i] != 0) pixel_of_number.at(number[i]) = static_cast<int>(i);
  }
  for (size_t i = 0; i < area; ++i) result[i] = pixel_of_number.at(number[i]);
  return result;
}

}  // namespace bodyloom
