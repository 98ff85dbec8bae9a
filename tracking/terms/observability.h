// SPDX-License-Identifier: Apache-2.0
/// Selects the joints that the observations determine.
#pragma once

#include <span>
#include <vector>

#include "geometry/body/body_model.h"
#include "tracking/problem/user_term.h"
#include "tracking/terms/landmarks.h"

namespace bodyloom {

/// Joints to estimate. With dense keypoints: all but fingers, which have no labels of their own there. Of fingers, and
/// of all joints with 2D joints only: those that move some observed landmark by at least 4 cm a radian at rest; the
/// others (wrists, hands, feet without toe detections) are determined only by the prior, and holding them at rest
/// affects observations by no more than that lever. `skip` false: all joints.
/// `ground`: ankles as well, because a ground lays the soles of standing feet flat (terms/surface_contact).
/// A landmark or surface point that a user's term reads counts as observed, and a joint that it reads is estimated.
std::vector<int> FindActiveJoints(const BodyModel& model, const ObservedLandmarks& landmarks, bool dense, bool skip,
                                  bool ground, std::span<const UserTerm> user_terms = {});

}  // namespace bodyloom
