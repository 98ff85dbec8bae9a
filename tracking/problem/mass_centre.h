// SPDX-License-Identifier: Apache-2.0
/// The centre of mass of a tracked body, by frame, and how it moves.
#pragma once

#include <Eigen/Core>

#include "geometry/body/body_model.h"
#include "tracking/problem/body_points.h"
#include "tracking/problem/sequence_problem.h"

namespace bodyloom {

/// The centre of mass (geometry/body/centre_of_mass.h) as a point of the body: a combination of the vertices of the
/// joint regressor. Without bones when the body lacks a joint of the table of masses.
CompiledPoint CompileCentreOfMass(const BodyModel& model, int num_betas);

/// Its position in each frame, 3×T, metres, in the frame of the states.
Eigen::Matrix3Xd CentresOfMass(const SequenceProblem& problem, const CompiledPoint& centre_of_mass, int num_threads);

inline constexpr double kCentreWindowS = 0.15;

/// Position and acceleration (m/s²) at a frame of the parabola fitted by least squares to the positions within
/// kCentreWindowS of it, in its shot. Not found with fewer than three frames in that time.
struct CentreMotion {
  bool found = false;
  Eigen::Vector3d place = Eigen::Vector3d::Zero(), acceleration = Eigen::Vector3d::Zero();
};
CentreMotion MotionAround(const SequenceProblem& problem, const Eigen::Matrix3Xd& centres, int t);
/// The same at frame t of the parabola fitted to the frames first … last.
CentreMotion MotionOver(const SequenceProblem& problem, const Eigen::Matrix3Xd& centres, int first, int last, int t);

}  // namespace bodyloom
