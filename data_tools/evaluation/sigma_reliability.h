// SPDX-License-Identifier: Apache-2.0
/// Reliability of a track's standard deviations: calibration against its errors, and correlation with them.
///
/// For a point, e = ‖x − x_true‖ is its error, both relative to the mid-hip, and σ the standard deviation along one
/// axis (Track::joint_sigma). For isotropic Gaussian errors, e/σ is below 1, 2 and 3 with the probabilities of a chi
/// distribution with three degrees of freedom: 19.9, 73.9 and 97.1 %.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "data_tools/evaluation/evaluation.h"
#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// An error and its stated standard deviation, metres.
struct JudgedSigma {
  double error_m = 0, sigma_m = 0;
};

struct SigmaReliability {
  int64_t count = 0;  ///< pairs of a finite error and a finite, positive σ; all others are left out
  std::array<double, 3> within_percent{};   ///< errors within one, two and three σ
  double log_correlation = 0;               ///< Pearson's, of log e and log σ; errors below 0.1 mm count as that
  double mean_m = 0;                        ///< mean error of all,
  double surest_90_m = 0, surest_75_m = 0;  ///< and of the 90 % and 75 % with the smallest σ
};

/// NaN where there are too few pairs.
SigmaReliability JudgeSigmas(std::span<const JudgedSigma> pairs);

/// Pairs of a track's landmarks 5 to 16 (shoulders to ankles; T of 17×3, relative to the mid-hip, as `truth`) and of
/// the joint_sigma of frame source[t] of the body joint of the same name; SMPL's joint names.
std::vector<JudgedSigma> JudgedLandmarks(const Track& track, const std::vector<int>& source,
                                         const std::vector<MatrixX3d>& from_hips,
                                         const std::vector<MatrixX3d>& true_from_hips);

/// Pairs of all joints of the body but its root, T of J×3 each in any position, aligned at the midpoint of the joints
/// l_hip and r_hip (for a body without them, at the root).
std::vector<JudgedSigma> JudgedJoints(const Track& track, const std::vector<int>& source, const BodyModel& body,
                                      const std::vector<MatrixX3d>& joints, const std::vector<MatrixX3d>& true_joints);

/// sigma_within_{1,2,3}_percent, sigma_log_correlation, sigma_surest_{90,75}_mm; nothing without pairs.
void AddSigmaReliability(std::span<const JudgedSigma> pairs, Evaluation* result);

}  // namespace bodyloom
