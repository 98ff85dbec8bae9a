// SPDX-License-Identifier: Apache-2.0
/// cv::Mat views of an Image without copying, for .cc files that call OpenCV.
#pragma once

#include <opencv2/core/mat.hpp>

#include "render/image/image.h"

namespace bodyloom {

/// Valid as long as the image lives and keeps its size.
inline cv::Mat MatOf(Image* image) { return {image->height, image->width, CV_8UC3, image->bgr.data()}; }

/// Read-only by convention: OpenCV has no type for a const view.
inline const cv::Mat MatOf(const Image& image) {
  return {image.height, image.width, CV_8UC3, const_cast<uint8_t*>(image.bgr.data())};
}

}  // namespace bodyloom
