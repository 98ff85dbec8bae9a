// SPDX-License-Identifier: Apache-2.0
/// Colours and pixels as OpenCV's drawing functions take them, for .cc files that call these: pixels in fixed point, so
/// that lines move smoothly from frame to frame.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <opencv2/core/types.hpp>

#include "render/image/image.h"

namespace bodyloom {

/// The argument `shift` of these functions: pixels in units of 1/16.
inline constexpr int kDrawingShift = 4;

/// Further from the image's corner than this, pixels, OpenCV's fixed point would overflow.
inline constexpr double kFurthestDrawnPx = 1e5;

inline bool IsDrawable(const Eigen::Vector2d& pixel) {
  return pixel.allFinite() && pixel.cwiseAbs().maxCoeff() <= kFurthestDrawnPx;
}

/// Of a pixel that IsDrawable().
inline cv::Point FixedPoint(const Eigen::Vector2d& pixel) {
  return {static_cast<int>(std::lround(pixel.x() * (1 << kDrawingShift))),
          static_cast<int>(std::lround(pixel.y() * (1 << kDrawingShift)))};
}

inline cv::Scalar ScalarOf(const Colour& c) { return {double(c.blue), double(c.green), double(c.red)}; }

}  // namespace bodyloom
