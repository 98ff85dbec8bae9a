// SPDX-License-Identifier: Apache-2.0
/// Writes parts of a pose that were fitted after the body into its track, and nothing else.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/hand_skeleton.h"
#include "geometry/body/posed_body.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// Everything that a part changes in a frame of a track.
struct PartOfTrack {
  std::vector<int> turned;  ///< joints whose rotations change
  std::vector<int> placed;  ///< joints whose places change
  /// Rows of coco17 that change, with the names of their landmarks.
  std::vector<std::pair<int, std::string>> landmarks;
};

/// Rows of the track's coco17 whose landmarks' names end with one of these.
std::vector<std::pair<int, std::string>> CocoRowsNamed(const BodyModel& body, const Track& track,
                                                       const std::vector<std::string>& endings);

/// Elbow, wrist and finger joints of a hand; the head.
PartOfTrack PartOfHand(const BodyModel& body, const HandSkeleton& hand, const Track& track);
PartOfTrack PartOfHead(const BodyModel& body, const Track& track);

/// `rest`: the body's joints at rest, of the track's shape.
void PutPart(const BodyModel& body, const MatrixX3d& rest, const BodyPose& pose, const PartOfTrack& part, int t,
             Track* track);

}  // namespace bodyloom
