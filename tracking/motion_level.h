// SPDX-License-Identifier: Apache-2.0
/// How lively a clip's motion is, and the smoothness that suits it.
///
/// One σ of acceleration for everybody is too stiff for a break dance and too loose for somebody who stands: the first
/// loses the motion, the second follows the detector's noise. A first solve tells which it is.
#pragma once

#include "tracking/sequence_problem.h"

namespace bodyloom {

inline constexpr double kSigmaOfRms = 4, kLeastSigma = 17, kMostSigma = 40;  ///< 1, m/s², m/s²

/// Root mean square over frames and estimated joints of lever × angular acceleration (JointLevers, residuals/
/// acceleration_cost.h), m/s²; 0 without three consecutive frames. Differences of neighbouring frames: of a solve at
/// about TrackSequenceOptions::coarse_rate.
double TipAccelerationRms(const SequenceProblem& problem);

/// `smoothness` with both accelerations' σ scaled by the same factor: that of the tips becomes kSigmaOfRms × the rms,
/// in [kLeastSigma, kMostSigma]. Unchanged when the rms is 0, and for clips with cuts: one take's level says nothing of
/// another's.
Smoothness FitSmoothness(const SequenceProblem& problem, const Smoothness& smoothness);

}  // namespace bodyloom
