// SPDX-License-Identifier: Apache-2.0
/// Joint limits: the term
///   ½ Σ_j ‖e_j / σ‖²,   e_j = LimitExcess() of joint j's axis-angle, radians
/// in every frame, for the joints that are estimated; no kernel, because beyond the box nobody can be. The limits are
/// a box on the axis-angle of each joint's rotation from the T-pose, in SMPL's joint frames
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

class FrameAccumulator;

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

struct JointLimitsOfFrame {
  const JointLimits* limits = nullptr;  ///< borrowed; null: none
  double sigma = 0.05;                  ///< radians

  [[nodiscard]] static int num_rows() { return 0; }  ///< adds to the matrix directly
  void Add(FrameAccumulator* sums) const;
};

}  // namespace bodyloom
