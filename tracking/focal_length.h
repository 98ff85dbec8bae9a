// SPDX-License-Identifier: Apache-2.0
/// What fits of a clip say together of a focal length that is not known.
///
/// A fit's answer log f_i with standard deviation s_i is a Gaussian posterior of the prior (m, s), so its clip measured
/// x_i with variance v_i: 1/v_i = 1/s_i² − 1/s², x_i/v_i = log f_i/s_i² − m/s². The fits' covariances leave out that
/// neither the body's proportions nor its landmarks are the person's and the detector's, which errs alike for everybody
/// who is seen from the same side: b = kFocalFitLogSigma, not averaged away:
///   w_i = 1/(v_i + b²),   x = Σ w_i x_i / Σ w_i,   v = b² + Σ w_i² v_i / (Σ w_i)²,
///   1/S² = 1/s² + 1/v,    log f = S² (m/s² + x/v).
#pragma once

#include <span>

#include "bodyloom/tracking/camera_knowledge.h"

namespace bodyloom {

/// b: the root mean square of log(f_fit / f_true) over both clips and all nine cameras of AIST++ in shared/data, each
/// camera's detections fitted alone with an unknown focal length (docs/lab/two_people.md).
inline constexpr double kFocalFitLogSigma = 0.34;

/// Of log f, f in pixels.
struct FocalFit {
  double log_px = 0, log_sigma = 0;
};

/// Fits whose log_sigma is not a positive number are left out; without any it is the prior.
FocalFit JoinFocalFits(std::span<const FocalFit> fits, const FocalPrior& prior);

}  // namespace bodyloom
