// SPDX-License-Identifier: Apache-2.0
#include "tracking/clip/term_kinds.h"

#include <utility>

#include "tracking/clip/clip_views.h"
#include "tracking/problem/track_summary.h"
#include "tracking/problem/user_cost.h"
#include "tracking/terms/balance/clip_balance.h"
#include "tracking/terms/dense/dense.h"
#include "tracking/terms/ground_contact/clip_ground.h"
#include "tracking/terms/ground_contact/ground_contact.h"
#include "tracking/terms/initialiser.h"
#include "tracking/terms/joint_limits.h"
#include "tracking/terms/landmarks.h"
#include "tracking/terms/lifted/lifted_pose.h"
#include "tracking/terms/part_labels/part_labels.h"
#include "tracking/terms/pose_prior/pose_prior.h"
#include "tracking/terms/rendered_uv/rendered_uv.h"
#include "tracking/terms/straight_knees.h"
#include "tracking/terms/surface_contact/clip_contacts.h"
#include "tracking/terms/upright.h"

namespace bodyloom {

std::span<const TermKind> TermKinds() {
  static constexpr TermKind kKinds[] = {
      {PlanLandmarks, MakeLandmarkTerms},
      {PlanDense, MakeDenseTerms},
      {PlanRenderedUv, MakeDenseRounds},
      {PlanPartLabels, MakePartLabelRounds},
      {PlanLifted, MakeLiftedPoseTerms},
      {PlanGround, MakeClipGround},
      {PlanSurfaceContact, MakeClipContacts},
      {PlanBalance, MakeClipBalance},
      {PlanPosePrior, MakePosePriorTerms},
      {PlanJointLimits, MakeJointLimitTerms},
      {PlanUpright, MakeUprightTerms},
      {PlanStraightKnees, MakeStraightKneesTerms},
      {PlanInitialiser, MakeInitialiserTerms},
      {PlanUserTerms, MakeUserTerms},
      {PlanViews, MakeClipViews},
  };
  return kKinds;
}

namespace {

class EachFrameTerm : public ClipTerm {
 public:
  explicit EachFrameTerm(std::function<void(int, const FrameState&, FrameData*)> observe)
      : observe_(std::move(observe)) {}
  void Observe(SequenceProblem* problem) override {
    for (size_t t = 0; t < problem->frames.size(); ++t) {
      observe_(static_cast<int>(t), problem->states[t], &problem->frames[t]);
    }
  }

 private:
  std::function<void(int, const FrameState&, FrameData*)> observe_;
};

}  // namespace

std::unique_ptr<ClipTerm> EachFrame(std::function<void(int, const FrameState&, FrameData*)> observe) {
  return std::make_unique<EachFrameTerm>(std::move(observe));
}

}  // namespace bodyloom
