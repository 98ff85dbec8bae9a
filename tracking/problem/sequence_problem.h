// SPDX-License-Identifier: Apache-2.0
/// The clip as one least-squares problem: frames are coupled to their neighbours by acceleration, and all frames to
/// shape and camera.
///
/// Holds the unknowns independently of the solver (solve_sequence.h). Work and memory are linear in the number of
/// frames: a frame couples only to two neighbours on each side and to the shared columns.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "tracking/problem/frame_cost.h"
#include "tracking/problem/frame_layout.h"
#include "tracking/problem/user_cost.h"

namespace bodyloom {

/// The shot of each frame, counted from 0. Shots are the runs of frames between cuts.
std::vector<int> ShotOfFrames(const std::vector<char>& cut_before);

/// σ of the smoothness terms.
struct Smoothness {
  double tip_acceleration = 25;        ///< m/s²: at the far end of a joint's subtree; sets each joint's angular σ
  std::vector<double> of_joint;        ///< m/s²: tip_acceleration of each body joint by itself; empty: one for all
  double root_acceleration = 15;       ///< m/s²: of the translation, in all directions
  double weak_scale_acceleration = 2;  ///< 1/s²: of log scale (weak perspective)
};

struct ShapePrior {
  Eigen::VectorXd mean;  ///< B; empty: zero
  double sigma = 1.0;    ///< standard deviation of each beta; the body's components are in standard deviations
  double weight = 1.0;   ///< factor of the prior's cost
  double height_m = 0;   ///< 0: the mean body's. A single camera does not determine metric scale
  double height_sigma_m = 0.005;
};

/// The values are those at which a solve starts.
struct SequenceProblem : SharedValues {
  FrameLayout layout;
  std::vector<FrameData> frames;
  std::vector<FrameCoupling> couplings;  ///< users' cost functions on several frames
  std::vector<FrameState> states;
  std::vector<double> timestamps;  ///< seconds
  std::vector<char> cut_before;    ///< true where frame t does not continue frame t−1
  double log_focal_prior = 0, log_focal_sigma = FocalPrior().log_sigma;
  std::vector<Smoothness> smoothness = {Smoothness()};  ///< smoothness of each shot, or one for all of them
  double velocity_weight = 0;  ///< λ_t of velocities (residuals/acceleration_cost.h); 0: none. Not for a moving window
  ShapePrior shape_prior;
};

/// The same problem on a subset of the frames (ascending indices), for a solve that is coarse in time. Frame data is
/// copied; a cost function on several frames is dropped unless all its frames are selected.
SequenceProblem SelectFrames(const SequenceProblem& problem, const std::vector<int>& frames);

/// Applies the coarse solution: shape and focal length, the selected frames' states, and to frames between them the
/// change of the selected neighbours, interpolated on SO(3). There is no interpolation across cuts.
void SpreadFrames(const SequenceProblem& coarse, const std::vector<int>& frames, SequenceProblem* problem);

/// Selects about `rate` frames a second, always with the first and last frame of every shot. `anchors` (T flags, or
/// empty): the first of a shot is selected, and the others follow from it.
std::vector<int> FramesAtRate(const SequenceProblem& problem, double rate, const std::vector<char>& anchors = {});

/// σ of each body joint's angular acceleration in a shot, rad/s²: SequenceProblem::smoothness over JointLevers().
std::vector<double> JointAccelerationSigma(const SequenceProblem& problem, int shot = 0);

/// σ of the acceleration of the three translation parameters (metres, or log scale and offsets for weak perspective).
std::array<double, 3> RootAccelerationSigma(const SequenceProblem& problem, int shot = 0);

/// σ of each body joint's angular velocity, rad/s, and of the velocity of the three translation parameters: those for
/// which the far end of a joint's subtree, or the root, moves at 1/√velocity_weight m/s.
std::vector<double> JointVelocitySigma(const SequenceProblem& problem);
std::array<double, 3> RootVelocitySigma(const SequenceProblem& problem);

/// Rest-pose distance from a joint to the farthest joint below it, metres (at least 0.1): the lever that converts a
/// linear acceleration to an angular one.
std::vector<double> JointLevers(const BodyModel& model);

/// Stature h(β) = h0 + g·β: highest minus lowest vertex, linearised at the mean shape.
double StatureOfMeanShape(const BodyModel& model, int num_betas, Eigen::VectorXd* gradient);

/// Gaussian prior on a shared unknown, or on the difference of two: ½ ((value − mean) / σ)².
struct SharedPrior {
  std::string term;  ///< its name in the table of costs
  int column = 0;    ///< of the layout
  double value = 0, mean = 0, sigma = 1;
  int minus_column = -1;  ///< of the unknown that is subtracted; −1: none
};
/// The priors on focal lengths and clocks that are not known, at these values.
std::vector<SharedPrior> SharedPriors(const SequenceProblem& problem, const SharedValues& values);

/// Rows of the shape prior and of the stature prior: residual = A β + b.
void ShapePriorRows(const SequenceProblem& problem, RowMatrixXd* A, Eigen::VectorXd* b);

}  // namespace bodyloom
