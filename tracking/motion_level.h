// SPDX-License-Identifier: Apache-2.0
/// The motion level of a clip, and the smoothness that suits it.
///
/// One σ of acceleration for everybody is too stiff for a break dance and too loose for somebody who stands: the first
/// loses the motion, the second follows the detector's noise. So it is with one σ for all joints: arms swing while the
/// spine hardly moves. A first solve shows which is which.
#pragma once

#include <vector>

#include "bodyloom/tracking/sequence_problem.h"

namespace bodyloom {

inline constexpr double kSigmaOfRms = 4;                        ///< σ of what moves with an rms of 1
inline constexpr double kLeastSigma = 17, kMostSigma = 40;      ///< m/s², of the whole clip
inline constexpr double kLeastOfJoint = 10, kMostOfJoint = 60;  ///< m/s², of a joint

/// Root mean square over the frames of a shot of lever × angular acceleration (JointLevers, residuals/
/// acceleration_cost.h) of each body joint, m/s²; 0 for joints that are not estimated and without three consecutive
/// frames. Differences of neighbouring frames: of a solve at about TrackSequenceOptions::coarse_rate.
std::vector<double> TipAccelerationRms(const SequenceProblem& problem, int shot = 0);

/// Smoothness of each shot. Each joint's σ of acceleration is kSigmaOfRms × its rms, in [kLeastOfJoint, kMostOfJoint],
/// and both common ones are those of `before`, scaled by the same factor: that of the tips becomes kSigmaOfRms × the
/// root mean square over the estimated joints, in [kLeastSigma, kMostSigma]. A shot in which nothing accelerates keeps
/// `before`.
std::vector<Smoothness> FitSmoothness(const SequenceProblem& problem, const Smoothness& before);

}  // namespace bodyloom
