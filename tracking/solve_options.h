// SPDX-License-Identifier: Apache-2.0
/// Options and report of a solve of a SequenceProblem, common to both engines.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace bodyloom {

/// The engines: the same problem, the same rules of acceptance and of stopping.
enum class SequenceSolver {
  kCeres,          ///< Ceres with sparse Cholesky (ceres_solver.h)
  kChain,          ///< several times faster on a chain of frames (chain_solver.h)
  kChainThenCeres  ///< chain to near the minimum, and Ceres from there to its own convergence
};
/// "ceres", "chain" or "chain+ceres".
std::string ToString(SequenceSolver solver);
/// The other way; throws std::invalid_argument for another word.
SequenceSolver SequenceSolverFromString(const std::string& word);

enum class SolveStatus { kFailure, kConverged, kMaxIterations, kStopped };
std::string ToString(SolveStatus status);

/// Of the chain engine, what it may leave out on its way; Ceres does not read it.
struct ChainOptions {
  /// Until the cost changes by less than a thousandth, frames with more than twice as many dense keypoints use about
  /// this many, evenly chosen and weighted to represent all; then all of them. What converges is always the whole
  /// problem. 0: all from the beginning.
  int early_dense = 0;
  /// Frames whose residuals have moved by less than this share of their size since they were linearised last are not
  /// evaluated again; their linearisation is reused (ChainProblem::ReuseLinearisation). Before the descent may end as
  /// converged all frames are evaluated at the same point and iterations without reuse follow, so the answer is a
  /// minimum of the cost itself. 0: every frame in every iteration.
  double reuse_linearisation = 0;
  /// Frames of little predicted decrease are frozen, and shape and focal length with them, while the others go on
  /// (tracking/chain/frozen_frames.h): at most this share of a step's predicted decrease at a time. Only a step of all
  /// frames may end the descent as converged. Steps of a part of the frames count for max_iterations by its size, a
  /// quarter at least. 0: all frames move in every iteration.
  double frozen_share = 0;
  /// Also when max_iterations end the descent: the final cost may be that of reused linearisations.
  bool reuse_to_the_end = false;
};

struct SolveOptions {
  SequenceSolver solver = SequenceSolver::kCeres;
  int max_iterations = 50;
  int num_threads = 1;
  double function_tolerance = 1e-5;   ///< stop when |Δcost| is below this share of the cost
  double gradient_tolerance = 1e-9;   ///< … when no component of the gradient is larger
  double parameter_tolerance = 1e-9;  ///< … when the step is below this share of the unknowns' norm
  bool shape_constant = false, focal_constant = false;
  /// Ceres: a clip of more frames is solved in windows of so many that overlap, with shape and focal length held; 0:
  /// never. Not where users' terms couple frames.
  int max_frames_at_once = 0;
  ChainOptions chain;
  /// Called after each iteration with (iteration, cost); false stops.
  std::function<bool(int, double)> on_iteration;
};

/// What the tracker sets these to; linearisations are reused only where there are dense keypoints.
inline constexpr int kTrackerEarlyDense = 300;
inline constexpr double kTrackerReuse = 0.01, kTrackerFrozenShare = 0.05;
/// Of the last solve: Ceres takes 30 KB and more a frame at once (docs/lab/ceres_finish.md).
inline constexpr int kTrackerFramesAtOnce = 3000;

struct SolveReport {
  SolveStatus status = SolveStatus::kFailure;
  int iterations = 0;
  double initial_cost = 0, final_cost = 0, seconds = 0;
  double seconds_evaluation = 0, seconds_linear_solver = 0;  ///< parts of `seconds`
  int64_t frames_evaluated = 0, frames_skipped = 0;          ///< chain: frames × evaluations
  double gradient_max_norm = 0;                              ///< at the end, Ceres
  std::string message;
};

}  // namespace bodyloom
