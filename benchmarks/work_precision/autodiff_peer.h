// SPDX-License-Identifier: Apache-2.0
/// Solves a WorkProblem as a user of Ceres would formulate it: one small cost function per keypoint, acceleration and
/// prior of a frame, all derivatives by automatic differentiation, rotations as plain axis-angle blocks.
#pragma once

#include "tracking/problem/sequence_problem.h"
#include "tracking/problem/track_options.h"

namespace bodyloom {

/// Minimises the same cost as SolveSequence, with the same tolerances and the best settings found: a keypoint's cost
/// function depends only on the joints that move it, Jets carry 16 derivatives at a time, Ceres evaluates with
/// `num_threads`, sparse normal equations with SuiteSparse. Supports dense keypoints in pixels, a known pinhole camera
/// and all joints unknown, without cuts; throws std::invalid_argument for other problems.
SolveReport SolveWithAutoDiff(SequenceProblem* problem, const SolveOptions& options);

}  // namespace bodyloom
