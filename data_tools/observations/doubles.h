// SPDX-License-Identifier: Apache-2.0
/// Joins tracks of one body. A detector may find a body twice: once more beside the first, or turned upside down or
/// folded inside it.
///
/// Of two people in one frame only landmarks of a confidence of at least 0.3 count, five of each at least. Let s be the
/// larger diagonal of the boxes around them, pixels. If the boxes share less than 60 % of the smaller one's area, the
/// two are apart. Else the shorter track's person b (fewer frames) is
///   a double of a   if the landmarks that count in both, five at least, are less than 0.08 s apart in the mean, as
///                   they are named or with left and right exchanged
///   inside a        if the smaller diagonal is over 0.75 s, the joints of b lie within 0.04 s of a's nearest limb in
///                   the mean, and those of a within 0.06 s of b's; joints are nose, shoulders, elbows, wrists, hips,
///                   knees and ankles, limbs the lines between neighbouring ones
/// Two tracks are of one body if b is a double in at least half of the frames in which b is seen; or a double or
/// inside, where those are eight frames at least. People who hug, dance as a couple or stand one behind the other stay
/// two: their boxes overlap, their joints do not for long (docs/lab/two_people.md).
#pragma once

#include <vector>

#include "data_tools/observations/people.h"

namespace bodyloom {

/// Joins all tracks of one body. The longer keeps its detections. In frames where it has none it takes those of the
/// shorter, unless the shorter is of one body by what lies inside, whose pose is not the person's; its weight grows by
/// the shorter's mean weight a frame for each. PersonTrack::joined counts the tracks that ended so. Returns the tracks
/// that are left, in their order.
std::vector<PersonTrack> JoinDoubles(const PeopleSequence& people, std::vector<PersonTrack> tracks);

}  // namespace bodyloom
