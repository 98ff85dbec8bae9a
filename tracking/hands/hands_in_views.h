// SPDX-License-Identifier: Apache-2.0
/// Hands and head of a track that several cameras of a rig filmed: each hand, and the head, by the camera that shows it
/// in most frames (the first of equals), as fit_hands.h and turn_head.h do with one. Two cameras are not joined: where
/// the best one does not see a hand, it rests.
#pragma once

#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/hands_and_face.h"
#include "geometry/scene/rig.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

/// The hands and the face that one camera saw.
struct HandsOfView {
  RigCamera camera;           ///< relative to the track's; of the first view, the track's own, it is not used
  HandsAndFaceSequence seen;  ///< in the track's frames; without frames: nothing
};

/// Lines of the plan, as PlanHandsAndHead().
std::vector<PlanEntry> PlanHandsInViews(const BodyModel& body, const std::vector<HandsOfView>& views);

/// Fits the hands and turns the head, and adds to the summary, as FitHandsAndHead(). `cut_before`: T flags, or empty.
/// Of a moving camera's track only the first view is used. Throws std::invalid_argument for another number of frames.
void FitHandsInViews(const BodyModel& body, const std::vector<HandsOfView>& views, const std::vector<char>& cut_before,
                     int num_threads, TrackSequenceResult* result);

}  // namespace bodyloom
