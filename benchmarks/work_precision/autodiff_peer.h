// SPDX-License-Identifier: Apache-2.0
/// A WorkProblem's cost as a user of Ceres would state it: one small cost function a keypoint, an acceleration and a
/// frame's prior, every derivative by Ceres' automatic differentiation, rotations as plain axis-angle blocks.
#pragma once

#include "tracking/problem/sequence_problem.h"
#include "tracking/problem/track_options.h"

namespace bodyloom {

/// Minimises the same cost as SolveSequence, with the same tolerances. Best settings found: a keypoint's cost function
/// holds only the joints that move it, Jets carry 16 derivatives at a time, Ceres evaluates with `num_threads`, sparse
/// normal equations with SuiteSparse. Takes problems of dense keypoints in pixels, a known pinhole camera and all
/// joints unknown, without cuts; std::invalid_argument for others.
SolveReport SolveWithAutoDiff(SequenceProblem* problem, const SolveOptions& options);

}  // namespace bodyloom
