// SPDX-License-Identifier: Apache-2.0
/// Brings hands and faces that a camera of a rig saw to the frames of the first one's track.
#pragma once

#include <vector>

#include "geometry/scene/hands_and_face.h"
#include "tracking/hands/hands_in_views.h"

namespace bodyloom {

/// Index of the frame nearest to each of these times of the same clock; −1 where it is more than half a frame away.
/// `own`: strictly increasing, not empty.
std::vector<int> NearestFrames(const std::vector<double>& own, const std::vector<double>& times, double fps);

/// Hands and faces of the camera's frames nearest to `times` of the first one's clock. `own`: times of its frames,
/// by that clock if `first_clock`, else by the camera's.
HandsOfView HandsOfViewAt(const RigCamera& camera, const HandsAndFaceSequence& seen, std::vector<double> own,
                          bool first_clock, const std::vector<double>& times, double fps);

}  // namespace bodyloom
