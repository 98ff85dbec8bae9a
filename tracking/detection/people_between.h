// SPDX-License-Identifier: Apache-2.0
/// People in frames that were not detected, between two that were.
#pragma once

#include <vector>

#include "data_tools/observations/people.h"

namespace bodyloom {

/// Fills the frames t with detected[t] = 0. Whoever LinkPeople() finds in both detected frames around t, next to each
/// other among the detected ones, gets landmarks there that are linear in time:
///   p(t) = (1 − a) p(t₀) + a p(t₁),   a = (time − time₀) / (time₁ − time₀),
/// and the same for confidences; a landmark whose confidence is 0 in either frame has 0. Frames before the first and
/// after the last detected one stay as they are. Throws std::invalid_argument when `detected` has another length than
/// the clip.
void FillBetween(const std::vector<char>& detected, PeopleSequence* people);

/// The farthest that anybody of frame `a` has gone in frame `b`, as a share of the box around the person's landmarks
/// (its longer side, in `a`): the largest mean over the landmarks of one person, each person with the nearest of the
/// other frame. Infinite when the frames hold different numbers of people, or nobody.
double LargestStep(const std::vector<DetectedPerson>& a, const std::vector<DetectedPerson>& b);

}  // namespace bodyloom
