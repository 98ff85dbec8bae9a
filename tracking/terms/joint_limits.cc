// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/joint_limits.h"

#include <string>
#include <utility>

#include "geometry/math/rotation.h"
#include "tracking/problem/clip_term.h"
#include "tracking/problem/frame_accumulator.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;

JointLimits JointLimits::ForBody(const BodyModel& model) {
  struct Row {
    const char* joint;
    double x0, x1, y0, y1, z0, z1;
  };
  // Left side; the right side mirrors x → −x, which keeps rotations about x and turns those about y and z round.
  static constexpr Row kLeft[] = {
      {"l_hip", -2.4, 0.8, -1.2, 1.2, -1.0, 1.5},       // flexion about −x, abduction about +z
      {"l_knee", -0.10, 2.75, -0.6, 0.6, -0.35, 0.35},  // flexion about +x
      {"l_ankle", -0.9, 1.1, -0.7, 0.7, -0.7, 0.7},
      {"l_foot", -0.9, 0.6, -0.4, 0.4, -0.4, 0.4},
      {"l_collar", -0.5, 0.5, -0.7, 0.7, -0.6, 0.8},
      {"l_elbow", -1.9, 1.9, -2.75, 0.10, -0.6, 0.6},  // flexion about −y (forearm to the front), pronation about x
      {"l_wrist", -1.2, 1.2, -1.0, 1.0, -1.5, 1.5},
  };
  static constexpr Row kMiddle[] = {
      {"spine1", -0.6, 1.0, -0.7, 0.7, -0.6, 0.6}, {"spine2", -0.5, 0.8, -0.6, 0.6, -0.5, 0.5},
      {"spine3", -0.5, 0.7, -0.6, 0.6, -0.5, 0.5}, {"neck", -0.9, 0.9, -1.0, 1.0, -0.7, 0.7},
      {"head", -0.8, 0.8, -1.0, 1.0, -0.6, 0.6},
  };
  JointLimits limits;
  const auto add = [&](const std::string& name, const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) {
    const int joint = model.FindJoint(name);
    if (joint >= 0) limits.ranges.push_back({joint, lower, upper});
  };
  for (const Row& row : kLeft) {
    std::string name = row.joint;
    add(name, {row.x0, row.y0, row.z0}, {row.x1, row.y1, row.z1});
    name[0] = 'r';
    add(name, {row.x0, -row.y1, -row.z1}, {row.x1, -row.y0, -row.z0});
  }
  for (const Row& row : kMiddle) add(row.joint, {row.x0, row.y0, row.z0}, {row.x1, row.y1, row.z1});
  return limits;
}

Eigen::Vector3d LimitExcess(const JointLimits::Range& range, const Eigen::Vector3d& w) {
  return (w - range.upper).cwiseMax(0) - (range.lower - w).cwiseMax(0);
}

void JointLimitTerm::Add(FrameAccumulator* sums) const {
  if (limits == nullptr) return;
  for (const JointLimits::Range& range : limits->ranges) {
    const int column = sums->layout().column_of_joint[range.joint];
    if (column < 0) continue;
    const Vector3d w = AxisAngleFromRotation(sums->state().rotations[range.joint]);
    const Vector3d excess = LimitExcess(range, w) / sigma;
    if (excess.isZero(0) && !sums->one_by_one()) continue;
    sums->AddGroup(3, excess.squaredNorm(), 0, 1);
    if (!sums->derivatives()) continue;
    Matrix3d d_excess = RightJacobianInverse(w) / sigma;
    for (int c = 0; c < 3; ++c) {
      if (excess[c] == 0) d_excess.row(c).setZero();
    }
    sums->AddBlockRows<3>(column, d_excess, excess);
  }
}

std::vector<PlanEntry> PlanJointLimits(const TrackSequenceInput& input, const TrackSequenceOptions& /*options*/) {
  const size_t known = JointLimits::ForBody(*input.body).ranges.size();
  return {{"joint limits", known > 0, known > 0 ? std::to_string(known) + " joints" : "of no joint of this body"}};
}

std::unique_ptr<ClipTerm> MakeJointLimitTerms(const ClipTermInput& clip) {
  const auto limits = std::make_shared<const JointLimits>(JointLimits::ForBody(*clip.layout.model));
  return EachFrame(
      [limits](int, const FrameState&, FrameData* frame) { frame->Get<JointLimitTerm>().limits = limits; });
}

}  // namespace bodyloom
