// SPDX-License-Identifier: Apache-2.0
/// Tracks everybody in a raw video, step by step and in memory: detects people, selects those to track, and tracks them
/// as one scene.
#pragma once

#include <memory>
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
  TrackSettings track;        ///< video, span, detector, camera, other knowledge and solver
  int max_people = 0;         ///< maximum number, largest and longest in view first; 0: everybody
  std::optional<int> person;  ///< only this one, numbered as LinkPeople() does (0: the largest and longest in view)
  double min_seconds = 0.5;   ///< minimum time in view; in short clips half of the clip
};

/// Throws RequestError for a contradictory request. Its `track` is checked by CheckTrackSettings().
void CheckTrackPeopleRequest(const TrackPeopleRequest& request);

/// People found in the video and those selected for tracking.
struct ChosenPeople {
  DetectedClip clip;
  std::vector<PersonTrack> everybody;  ///< LinkPeople()
  std::vector<int> chosen;             ///< indices into `everybody` of the people to track
};

/// Detects, links and selects people. Throws std::runtime_error naming a file that cannot be used, NoPersonFound if
/// nobody is left, Cancelled.
ChosenPeople DetectAndChoosePeople(const TrackPeopleRequest& request, const PipelineCallbacks& callbacks);

/// True where no body is named or given: people are fitted with the built-in one, and the tracks of those who show a
/// hand are then put onto BuiltinBodyWithHands().
bool GivesFingers(const TrackPeopleRequest& request, const GivenInMemory& given);

/// The request's choice of hands and faces to look for; without one kAuto if `body` has fingers or tracks get them,
/// else kOff.
HandsAndFaceChoice HandsFor(const TrackPeopleRequest& request, const GivenInMemory& given, const BodyModel& body);

/// Report of the clip's detections and of the selected people.
TrackPeopleReport ReportOf(const TrackPeopleRequest& request, const ChosenPeople& people);

struct TrackedScene {
  std::vector<DetectedObservations> seen;  ///< of the selected people, from first to last frame in view
  std::vector<const BodyModel*> bodies;    ///< of the same people's tracks
  TrackPeopleResult result;                ///< of the same people
  bool any = false;                        ///< true if at least one person could be tracked
};

/// Tracks the selected people and adds the results to `report`, which is ReportOf() them; `gives_fingers`:
/// GivesFingers(). Warns by callbacks.Say() if a camera assumed to be static seems to move. Of the clip of
/// `chosen` detections, masks, samples and background are freed. Throws std::runtime_error, Cancelled.
TrackedScene TrackDetectedPeople(const TrackPeopleRequest& request, const SceneInputs& scene, ChosenPeople* chosen,
                                 bool gives_fingers, const PipelineCallbacks& callbacks, TrackPeopleReport* report);

/// Throws NoPersonFound with the reason if TrackedScene::any is false.
void RequireAnyTrack(const TrackPeopleRequest& request, const TrackedScene& tracked);

}  // namespace bodyloom
