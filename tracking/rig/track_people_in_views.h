// SPDX-License-Identifier: Apache-2.0
/// Follows all people of a scene through several cameras at once, of which nothing need be known.
///
/// Everybody is first fitted alone in every view, and people are matched by their motions (match_people.h). The person
/// whom the views agree about best tells the cameras and clocks (track_views.h); everybody else is fitted with these.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/rig/match_people.h"
#include "tracking/rig/track_views.h"

namespace bodyloom {

/// The people that one camera saw, and what is known of the camera.
struct ObservedScene {
  std::vector<const KeypointSequence*> people;  ///< with timestamps of the camera's own clock
  ObservedView camera;                          ///< without keypoints
};

struct TrackPeopleInViewsResult {
  std::vector<TrackSequenceResult> people;  ///< of the first view's people, in its camera's frame and time
  /// Of each of them, the person in each view; −1: not seen there, or moves otherwise. Who is in the first view alone
  /// is fitted from it.
  std::vector<std::vector<int>> person_in_view;
  int leader = -1;                  ///< the person who told the cameras; −1: no view shows anybody's motion
  std::vector<MatchedViews> views;  ///< of each view but the first
  /// The cameras by the leader's fit, as ViewSummary, for the views that were used; used[v] as of TrackViewsSummary.
  std::vector<ViewSummary> cameras;
  std::vector<char> used;
  std::string why;  ///< the reason why there is no leader
};

/// Throws std::invalid_argument as TrackViews(), and when the first view has no people.
TrackPeopleInViewsResult TrackPeopleInViews(const std::vector<ObservedScene>& views, const TrackSequenceInput& common,
                                            const TrackSequenceOptions& options);

}  // namespace bodyloom
