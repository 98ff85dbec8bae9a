// SPDX-License-Identifier: Apache-2.0
/// How far joints turn: a box on the axis-angle of each joint's rotation from the T-pose, in SMPL's joint frames
/// (x left, y up, z front; arms along ±x, palms down). Outside the box the excess is penalised quadratically.
///
/// Ranges follow the adult ranges of motion of the American Academy of Orthopaedic Surgeons (1965: elbow 0–150°, knee
/// 0–135°, extended to the passive limit reached in squats, hip flexion 120°), widened by 10–20°, because they shall
/// exclude the impossible only; what is likely is the pose prior's business.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bodyloom/geometry/body_model.h"

namespace bodyloom {

struct JointLimits {
  struct Range {
    int joint = 0;
    Eigen::Vector3d lower, upper;  ///< radians
  };
  std::vector<Range> ranges;

  /// The table for the joints that the body has by name; unknown joints are free.
  static JointLimits ForBody(const BodyModel& model);
};

/// max(0, w − upper) − max(0, lower − w), component by component: zero inside the box.
Eigen::Vector3d LimitExcess(const JointLimits::Range& range, const Eigen::Vector3d& axis_angle);

}  // namespace bodyloom
