// SPDX-License-Identifier: Apache-2.0
/// Errors of joints in a world, after alignments over many frames, as EMDB defines them (Kaufmann et al., ICCV 2023,
/// section 4).
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "geometry/math/arrays.h"

namespace bodyloom {

/// NaN: not measured.
struct GlobalErrors {
  double w_mpjpe_100_m = 0;   ///< windows of 100 frames, after a similarity fitted on their first two
  double wa_mpjpe_100_m = 0;  ///< the same, fitted on the whole window
  double rte = 0;  ///< mean distance of the roots after one rigid motion for the clip / length of the true roots' path
};

/// `joints`, `true_joints`: T of J×3 metres; `roots`, `true_roots`: T×3. Windows follow one another without overlap; a
/// shorter rest is not counted. Throws std::invalid_argument when sizes disagree.
GlobalErrors MeasureGlobalErrors(const std::vector<MatrixX3d>& joints, const std::vector<MatrixX3d>& true_joints,
                                 const MatrixX3d& roots, const MatrixX3d& true_roots);

/// All points, frame after frame; at least one frame, all of as many points.
MatrixX3d StackedFrames(std::span<const MatrixX3d> frames);

/// Moves `points` by the motion of a family that takes `fitted` nearest to `target`.
using FittedMotion =
    std::function<MatrixX3d(const MatrixX3d& points, const MatrixX3d& fitted, const MatrixX3d& target)>;

/// Mean over the windows of 100 frames of the mean joint error after a motion fitted on the first `fitted_frames` of
/// each; NaN without a whole window. Sizes are the caller's responsibility.
double WindowError(const std::vector<MatrixX3d>& joints, const std::vector<MatrixX3d>& true_joints, int fitted_frames,
                   const FittedMotion& moved);

}  // namespace bodyloom
