// SPDX-License-Identifier: Apache-2.0
/// The clip as one least-squares problem: frames coupled to their neighbours by acceleration, all to shape and camera.
///
/// The unknowns live here, in plain form; SolveSequence hands them to Ceres and takes them back. Work and memory grow
/// linearly with the number of frames: a frame couples to two neighbours on each side and to the shared columns only.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bodyloom/tracking/frame_cost.h"

namespace bodyloom {

/// σ of the smoothness terms.
struct Smoothness {
  double tip_acceleration = 25;        ///< m/s²: of the far end of what a joint moves; sets each joint's angular σ
  std::vector<double> of_joint;        ///< m/s²: tip_acceleration of each body joint by itself; empty: one for all
  double root_acceleration = 15;       ///< m/s²: of the translation across the view and along it
  double weak_scale_acceleration = 2;  ///< 1/s²: of log scale (weak perspective)
};

struct ShapePrior {
  Eigen::VectorXd mean;  ///< B; empty: zero
  double sigma = 1.0;    ///< of each beta; the body's components are in standard deviations
  double weight = 1.0;   ///< how many times the prior counts
  double height_m = 0;   ///< 0: the mean body's. Metric scale cannot be seen by one camera
  double height_sigma_m = 0.005;
};

struct SequenceProblem {
  FrameLayout layout;
  std::vector<FrameData> frames;
  std::vector<FrameState> states;
  std::vector<double> timestamps;  ///< seconds
  std::vector<char> cut_before;    ///< true where frame t does not continue frame t−1
  Eigen::VectorXd betas;
  double log_focal = 0;
  double log_focal_prior = 0, log_focal_sigma = 0.25;
  std::vector<Smoothness> smoothness = {Smoothness()};  ///< of each shot, or one for all of them
  ShapePrior shape_prior;
};

/// The engines of SolveSequence: the same problem, the same rules of acceptance and of stopping.
enum class SequenceSolver {
  kCeres,  ///< Ceres with sparse Cholesky: the reference
  kChain   ///< tracking/chain_solver.h
};

struct SolveOptions {
  SequenceSolver solver = SequenceSolver::kCeres;
  int max_iterations = 50;
  int num_threads = 1;
  double function_tolerance = 1e-5;   ///< stop when |Δcost| is below this share of the cost
  double gradient_tolerance = 1e-9;   ///< … when no component of the gradient is larger
  double parameter_tolerance = 1e-9;  ///< … when the step is below this share of the unknowns' norm
  /// Chain only: until the cost settles to a thousandth, frames with more than twice as many dense keypoints use about
  /// this many, evenly chosen and weighted to stand for all; then all of them. What converges is always the whole
  /// problem. 0: all from the beginning.
  int early_dense = 0;
  /// Chain only: frames whose residuals have moved by less than this share of their size since they were linearised
  /// last are not evaluated again; a quadratic stands for them (ChainProblem::SkipSettled). Before the descent may end
  /// as converged all frames are evaluated at the same point and iterations without the skip follow, so the answer is a
  /// minimum of the cost itself. 0: every frame in every iteration.
  double skip_settled = 0;
  /// Chain only: frames whose steps promise little rest, and shape and focal length with them, while the others go on
  /// (tracking/chain/resting_frames.h); this share of a step's decrease is left lying at a time. Only a step of all
  /// frames may end the descent as converged. Steps of a part of the frames count for max_iterations by its size, a
  /// quarter at least. 0: all frames move in every iteration.
  double rest_share = 0;
  /// Leave it at that when max_iterations end the descent: the final cost may hold stand-ins.
  bool skip_to_the_end = false;
  bool shape_constant = false, focal_constant = false;
  /// Called after each iteration with (iteration, cost); false stops.
  std::function<bool(int, double)> on_iteration;
};

/// What the tracker sets the skips to; settled frames only where there are dense keypoints.
inline constexpr int kTrackerEarlyDense = 300;
inline constexpr double kTrackerSkipSettled = 0.01, kTrackerRestShare = 0.05;

struct SolveReport {
  SolveStatus status = SolveStatus::kFailure;
  int iterations = 0;
  double initial_cost = 0, final_cost = 0, seconds = 0;
  double seconds_evaluation = 0, seconds_linear_solver = 0;  ///< parts of `seconds`
  int64_t frames_evaluated = 0, frames_skipped = 0;          ///< chain: frames × evaluations
  std::string message;
};

/// The problem's states, betas and log_focal hold the answer afterwards. The answer is the same to the last bit for any
/// number of threads. Throws std::invalid_argument when the problem's sizes contradict each other.
SolveReport SolveSequence(SequenceProblem* problem, const SolveOptions& options);

/// The same problem on a subset of the frames (ascending indices): a coarse solve in time. Frame data is copied.
SequenceProblem SelectFrames(const SequenceProblem& problem, const std::vector<int>& frames);

/// Takes the coarse answer back: shape and focal length, the selected frames' states, and for frames between them the
/// change of the selected neighbours, interpolated on SO(3). Frames are not changed across cuts.
void SpreadFrames(const SequenceProblem& coarse, const std::vector<int>& frames, SequenceProblem* problem);

/// About `rate` frames a second, always with the first and last frame of every shot.
std::vector<int> FramesAtRate(const SequenceProblem& problem, double rate);

/// The shot of each frame, counted from 0: a cut begins the next one.
std::vector<int> ShotOfFrames(const std::vector<char>& cut_before);

/// σ of each body joint's angular acceleration, rad/s²: Smoothness over JointLevers(). Of SequenceProblem::smoothness
/// the one of this shot.
std::vector<double> JointAccelerationSigma(const SequenceProblem& problem, int shot = 0);

/// σ of the acceleration of the three translation parameters (metres, or log scale and offsets for weak perspective).
std::array<double, 3> RootAccelerationSigma(const SequenceProblem& problem, int shot = 0);

/// Rest-pose distance from a joint to the farthest joint below it, metres (at least 0.1): the lever that turns a linear
/// acceleration into an angular one.
std::vector<double> JointLevers(const BodyModel& model);

/// Stature h(β) = h0 + g·β: highest minus lowest vertex of the mean shape, followed linearly.
double StatureOfMeanShape(const BodyModel& model, int num_betas, Eigen::VectorXd* gradient);

/// Rows of the shape prior and of the stature prior: residual = A β + b.
void ShapePriorRows(const SequenceProblem& problem, RowMatrixXd* A, Eigen::VectorXd* b);

}  // namespace bodyloom
