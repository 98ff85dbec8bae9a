// SPDX-License-Identifier: Apache-2.0
/// OpenCV's view of an Image, without copying: for .cc files that call OpenCV.
#pragma once

#include <opencv2/core/mat.hpp>

#include "render/image/image.h"

namespace bodyloom {

/// Valid as long as the image lives and keeps its size.
inline cv::Mat MatOf(Image* image) { return {image->height, image->width, CV_8UC3, image->bgr.data()}; }

/// To read only: OpenCV has no type for a view that may not be written.
inline const cv::Mat MatOf(const Image& image) {
  return {image.height, image.width, CV_8UC3, const_cast<uint8_t*>(image.bgr.data())};
}

}  // namespace bodyloom
