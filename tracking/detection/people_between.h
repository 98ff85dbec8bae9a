// SPDX-License-Identifier: Apache-2.0
/// Interpolates people in the frames between two frames with detections.
#pragma once

#include <vector>

#include "data_tools/observations/people.h"

namespace bodyloom {

/// The point on the straight line from `before` to `after`, linear in its confidence too; confidence 0 if either has 0.
Keypoint Between(const Keypoint& before, const Keypoint& after, double share);

/// Fills the frames t with detected[t] = 0. Each person whom LinkPeople() finds in both detected frames nearest to t,
/// before and after it, gets landmarks that are linear in time:
///   p(t) = (1 − a) p(t₀) + a p(t₁),   a = (time − time₀) / (time₁ − time₀),
/// and the same for confidences; a landmark whose confidence is 0 in either frame has 0. Hands and faces are left out,
/// as they turn too fast. Frames before the first and after the last detected one stay as they are. Throws
/// std::invalid_argument when `detected` has another length than the clip.
void FillBetween(const std::vector<char>& detected, PeopleSequence* people);

/// Largest displacement of a person from frame `a` to frame `b`, relative to the longer side of the box around the
/// person's landmarks in `a`: the maximum over people of the mean over landmarks, each person matched to the nearest of
/// the other frame. Infinite when the frames hold different numbers of people, or nobody.
double LargestStep(const std::vector<DetectedPerson>& a, const std::vector<DetectedPerson>& b);

}  // namespace bodyloom
