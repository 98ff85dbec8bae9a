// SPDX-License-Identifier: Apache-2.0
/// Joint limits: the term
///   ½ Σ_j ‖e_j / σ‖²,   e_j = LimitExcess() of joint j's axis-angle, radians
/// in every frame, for the joints that are estimated; without a kernel, because poses outside the box are impossible.
/// The limits are a box on the axis-angle of each joint's rotation from the T-pose, in SMPL's joint frames (x left, y
/// up, z front; arms along ±x, palms down). Outside the box the excess is penalised quadratically.
///
/// Ranges follow the adult ranges of motion of the American Academy of Orthopaedic Surgeons (1965: elbow 0–150°, knee
/// 0–135°, extended to the passive limit reached in squats, hip flexion 120°), widened by 10–20°, because they exclude
/// only impossible poses; the pose prior models which poses are likely.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "tracking/problem/frame_term.h"

namespace bodyloom {

class ClipTerm;
struct ClipTermInput;
struct PlanEntry;
struct TrackSequenceInput;
struct TrackSequenceOptions;

struct JointLimits {
  struct Range {
    int joint = 0;
    Eigen::Vector3d lower, upper;  ///< radians
  };
  std::vector<Range> ranges;

  /// The table of ranges for the body's joints, found by name; unknown joints are free.
  static JointLimits ForBody(const BodyModel& model);
};

/// max(0, w − upper) − max(0, lower − w), component by component: zero inside the box.
Eigen::Vector3d LimitExcess(const JointLimits::Range& range, const Eigen::Vector3d& axis_angle);

class JointLimitTerm : public CopyableTerm<JointLimitTerm> {
 public:
  std::shared_ptr<const JointLimits> limits;  ///< null: none
  double sigma = 0.05;                        ///< radians

  [[nodiscard]] std::string name() const override { return "joint limits"; }
  [[nodiscard]] int num_rows() const override {
    return limits == nullptr ? 0 : static_cast<int>(3 * limits->ranges.size());
  }
  void Add(FrameAccumulator* sums) const override;
};

std::vector<PlanEntry> PlanJointLimits(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::unique_ptr<ClipTerm> MakeJointLimitTerms(const ClipTermInput& clip);

}  // namespace bodyloom
