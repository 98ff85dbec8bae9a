// SPDX-License-Identifier: Apache-2.0
/// Files of the pose prior: one .npz with `joints` (names), `log_weights` K, `means` K×D, `covariance_upper` K×D(D+1)/2
/// (row by row, float32), `arm_log_density` and `leg_log_density` N×N in int8 steps of 1/16.
#pragma once

#include <string>

#include "geometry/scene/pose_prior.h"

namespace bodyloom {

void WritePosePrior(const std::string& path, const PosePrior& prior);
/// Throws std::runtime_error naming the file, the array and what was expected.
PosePrior ReadPosePrior(const std::string& path);
PosePrior ReadPosePriorBytes(const std::string& bytes, const std::string& where);

/// The prior that ships with the project (assets/prior/pose_prior.npz, embedded), learned from motion capture.
const PosePrior& BuiltinPosePrior();

}  // namespace bodyloom
