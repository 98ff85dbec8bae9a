// SPDX-License-Identifier: Apache-2.0
/// Follows all people of a scene through several cameras at once, of which nothing need be known.
///
/// Everybody is first fitted alone in every view, and people are matched by their motions (match_people.h). The person
/// whose motion is the best evidence, the leader, tells cameras and clocks (track_views.h), with which everybody else
/// is fitted. The verticals and grounds of these fits are joined (room/shared_scene.h), and several people are fitted
/// again with the common one.
#pragma once

#include <string>
#include <vector>

#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/rig/match_people.h"
#include "tracking/rig/track_views.h"
#include "tracking/room/shared_scene.h"

namespace bodyloom {

/// The people that one camera saw, and what is known of the camera.
struct ObservedScene {
  std::vector<const KeypointSequence*> people;  ///< with timestamps of the camera's own clock; may be none
  ObservedView camera;                          ///< without keypoints
};

struct TrackPeopleInViewsResult {
  /// Of the first view's people, in its camera's frame, time and scale. Who is in the first view alone is fitted from
  /// it. Without a leader all have status kFailure, with the reason.
  std::vector<TrackSequenceResult> people;
  /// Of each of them, the person in each view; −1: not seen there, or moves otherwise.
  std::vector<std::vector<int>> person_in_view;
  int leader = -1;                    ///< −1: no other view shows the motion of anybody in the first
  std::vector<std::string> left_out;  ///< of each view: the reason why it is not used; empty where it is
  std::vector<ViewSummary> cameras;   ///< of each view but the first; as they are made where it is not used
  /// Focal length of the first camera by the leader's fit; vertical and ground of all.
  SharedScene scene;
};

/// `common` as of TrackViews(). Progress runs over all fits; when its callback returns false, the fits so far are
/// returned. Throws std::invalid_argument as TrackViews(), and when the first view has no people.
TrackPeopleInViewsResult TrackPeopleInViews(const std::vector<ObservedScene>& views, const TrackSequenceInput& common,
                                            const TrackSequenceOptions& options);

}  // namespace bodyloom
