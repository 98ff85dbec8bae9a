// SPDX-License-Identifier: Apache-2.0
/// Camera intrinsics that a solve takes as known, and priors on an unknown focal length.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

namespace bodyloom {

/// Knowledge of the camera's intrinsics.
enum class CameraKnowledge {
  kKnown,         ///< TrackSequenceInput::camera is used as it is
  kUnknownFocal,  ///< pinhole, square pixels, centred principal point, focal length estimated with the clip
  kWeak,          ///< weak perspective: scale and image offset per frame (the camera of paper A)
};

/// Starting value of an unknown focal length: 0.9 of the longer side, a field of view of 58°.
inline double StartFocalPx(int width, int height) { return 0.9 * std::max(width, height); }

/// The prior on the logarithm of a focal length that is not known.
struct FocalPrior {
  double log_mean = 0, log_sigma = 0.25;
  static FocalPrior ForImage(int width, int height) { return {.log_mean = std::log(StartFocalPx(width, height))}; }
  /// For a lens with the diagonal angle of view of `focal_35mm_mm` on film of 36 mm × 24 mm, whose diagonal is 43.27
  /// mm.
  static FocalPrior ForLens(int width, int height, double focal_35mm_mm, double log_sigma) {
    return {.log_mean = std::log(focal_35mm_mm / std::hypot(36.0, 24.0) * std::hypot(width, height)),
            .log_sigma = log_sigma};
  }
};

// Joint estimate of an unknown focal length from several fits of a clip.
//
// A fit's estimate log f_i with standard deviation s_i is a Gaussian posterior of the prior (m, s), so its clip
// measured x_i with variance v_i: 1/v_i = 1/s_i² − 1/s², x_i/v_i = log f_i/s_i² − m/s². The fits' covariances do not
// include that the body's proportions and landmarks differ from the person's and the detector's. This error is common
// to all people seen from the same side, so it is not averaged: b = kFocalFitLogSigma,
//   w_i = 1/(v_i + b²),   x = Σ w_i x_i / Σ w_i,   v = b² + Σ w_i² v_i / (Σ w_i)²,
//   1/S² = 1/s² + 1/v,    log f = S² (m/s² + x/v).

/// b: the root mean square of log(f_fit / f_true) over both clips and all nine cameras of AIST++ in shared/data, each
/// camera's detections fitted alone with an unknown focal length (docs/lab/two_people.md).
inline constexpr double kFocalFitLogSigma = 0.34;

/// Estimate of log f, f in pixels, with its standard deviation.
struct FocalFit {
  double log_px = 0, log_sigma = 0;
};

/// Joins fits and prior as above. Fits whose log_sigma is not a positive number are ignored; without any the result is
/// the prior.
FocalFit JoinFocalFits(std::span<const FocalFit> fits, const FocalPrior& prior);

}  // namespace bodyloom
