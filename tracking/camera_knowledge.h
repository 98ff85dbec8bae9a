// SPDX-License-Identifier: Apache-2.0
/// Camera knowledge: how much of the camera a solve takes as known.
#pragma once

#include <algorithm>
#include <cmath>

namespace bodyloom {

/// What is known about the camera's intrinsics.
enum class CameraKnowledge {
  kKnown,         ///< TrackSequenceInput::camera is used as it is
  kUnknownFocal,  ///< pinhole, square pixels, centred principal point, focal length estimated with the clip
  kWeak,          ///< weak perspective: scale and image offset per frame (the camera of paper A)
};

/// Where a focal length that is not known starts: 0.9 of the longer side, a field of view of 58°.
inline double StartFocalPx(int width, int height) { return 0.9 * std::max(width, height); }

/// The prior on the logarithm of a focal length that is not known.
struct FocalPrior {
  double log_mean = 0, log_sigma = 0.25;
  static FocalPrior ForImage(int width, int height) { return {.log_mean = std::log(StartFocalPx(width, height))}; }
  /// Of a lens with the diagonal angle of view of `focal_35mm_mm` on film of 36 mm × 24 mm, whose picture is
  /// 43.27 mm long from corner to corner.
  static FocalPrior ForLens(int width, int height, double focal_35mm_mm, double log_sigma) {
    return {.log_mean = std::log(focal_35mm_mm / std::hypot(36.0, 24.0) * std::hypot(width, height)),
            .log_sigma = log_sigma};
  }
};

}  // namespace bodyloom
