// SPDX-License-Identifier: Apache-2.0
/// Points of a body's surface that can touch the ground, and their heights above it.
///
/// Of the vertices that follow a joint more than any other, those are taken that lie farthest along each of the body's
/// six axes in the rest pose: knees, seat, back, elbows, hands, head. Of ankles and feet, which are rigid, those are
/// taken that lie farthest down on both sides, to the end and up: heels, balls, toes, instep. Joints that lead fewer
/// than four vertices have none.
#pragma once

#include <vector>

#include "geometry/body/body_model.h"
#include "tracking/problem/body_points.h"
#include "tracking/problem/sequence_problem.h"

namespace bodyloom {

struct ContactPoint {
  int vertex = 0;
  int joint = 0;      ///< that it follows
  int leg = -1;       ///< of hip, knee, ankle or foot: 0 left, 1 right; -1: of none
  bool sole = false;  ///< of an ankle or foot, and within 1.5 cm of the lowest vertex of the rest pose
  double rest_m = 0;  ///< of a sole: height above that vertex in the rest pose, in which feet stand flat
};

/// Ascending by vertex, each vertex once.
std::vector<ContactPoint> FindContactPoints(const BodyModel& model);

/// Places of contact points in the frames of a problem; scratch memory is reused between frames.
class ContactPlaces {
 public:
  /// One column of `places` for each point: positions in the frame of the states, metres.
  void Evaluate(const SequenceProblem& problem, int frame, const std::vector<ContactPoint>& points,
                Eigen::Matrix3Xd* places);

 private:
  Kinematics kinematics_;
  PointEvaluator::VertexCache vertices_;
};

}  // namespace bodyloom
