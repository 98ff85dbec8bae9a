// SPDX-License-Identifier: Apache-2.0
/// Everybody in a raw video, step by step and in memory: found, chosen, tracked as one scene.
#pragma once

#include <optional>
#include <vector>

#include "data_tools/observations/people.h"
#include "geometry/base/callbacks.h"
#include "geometry/scene/camera.h"
#include "pipelines/detect/detect_people.h"
#include "pipelines/track/detected_people.h"
#include "pipelines/track/scene_inputs.h"
#include "pipelines/track/track_people_report.h"
#include "pipelines/track/track_request.h"
#include "tracking/people/track_people.h"

namespace bodyloom {

struct TrackPeopleRequest {
  TrackSettings track;         ///< the video, its span, the detector, the camera, what else is known and how to solve
  int max_people = 0;          ///< at most so many: the largest and longest in view; 0: everybody
  std::optional<int> person;   ///< only this one, numbered as LinkPeople() does (0: the largest and longest in view)
  double least_seconds = 0.5;  ///< whoever is seen for less is left out; in short clips half of the clip
};

/// Throws RequestError for a request that contradicts itself. `track` of it is checked by CheckTrackSettings().
void CheckTrackPeopleRequest(const TrackPeopleRequest& request);

/// Of the video, before anybody is tracked.
struct PeopleInClip {
  DetectedClip clip;
  std::vector<PersonTrack> everybody;  ///< LinkPeople()
  std::vector<int> chosen;             ///< numbers in `everybody` of those who are to be tracked
};

/// Detects, links and chooses. Throws std::runtime_error naming a file that cannot be used, NothingToTrack where nobody
/// is left, Cancelled.
PeopleInClip FindPeopleInClip(const TrackPeopleRequest& request, const PipelineCallbacks& callbacks);

/// What the detections say of the clip and of those chosen.
TrackPeopleReport ReportOf(const TrackPeopleRequest& request, const PeopleInClip& people);

struct TrackedInClip {
  std::vector<DetectedObservations> seen;  ///< of those chosen, from the first frame that shows them to the last
  TrackPeopleResult result;                ///< of the same
  bool any = false;                        ///< somebody could be tracked
};

/// Tracks those chosen; `report`, which is ReportOf() them, gets what came of it. A camera that seems to move although
/// nothing said so is told of by callbacks.Say(). Throws std::runtime_error, Cancelled.
TrackedInClip TrackPeopleInClip(const TrackPeopleRequest& request, const SceneInputs& scene, const PeopleInClip& people,
                                const PipelineCallbacks& callbacks, TrackPeopleReport* report);

/// Throws NothingToTrack, saying why, where TrackedInClip::any is false.
void RequireSomebodyTracked(const TrackPeopleRequest& request, const TrackedInClip& tracked);

}  // namespace bodyloom
