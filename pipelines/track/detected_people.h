// SPDX-License-Identifier: Apache-2.0
/// Converts people detected in a video to observations of the tracker, in the pixels of its camera.
#pragma once

#include <optional>
#include <utility>

#include "data_tools/observations/people.h"
#include "geometry/base/callbacks.h"
#include "geometry/scene/hands_and_face.h"
#include "geometry/scene/observations.h"
#include "pipelines/detect/detect_people.h"
#include "pipelines/detect/upright_people.h"
#include "pipelines/track/scene_inputs.h"
#include "pipelines/track/track_request.h"

namespace bodyloom {

/// Observations of one person.
struct DetectedObservations {
  KeypointSequence keypoints;
  HandsAndFaceSequence hands_and_face;
  std::optional<PartLabelSequence> mask;  ///< none when the request uses no masks
};

/// First and last frame, both included.
using ClipFrames = std::pair<int, int>;
ClipFrames WholeClip(const DetectedClip& clip);
/// From the person's first to the last detection.
ClipFrames SpanOf(const PersonTrack& person);

/// Detection request made of the request's fields, with at most `max_people` people at a time (0: everybody).
DetectPeopleRequest DetectionOf(const TrackSettings& request, int max_people = 0);

/// The settings with the turn of their video, which FindTurn() finds if they do not give it.
template <typename Settings>
Settings WithTurn(Settings settings, const PipelineCallbacks& callbacks) {
  if (!settings.turn_deg) settings.turn_deg = FindTurn(DetectionOf(settings), callbacks);
  return settings;
}

/// DetectPeople() by DetectionOf().
DetectedClip DetectForTracking(const TrackSettings& request, const PipelineCallbacks& callbacks, int max_people = 0);

/// The person's landmarks and mask in these frames, missing where the person was not detected. Landmarks with a
/// confidence below request.min_confidence are also missing. Throws std::runtime_error when the aspect ratio of the
/// scene's camera differs from the video's.
DetectedObservations ObservationsOf(const DetectedClip& clip, const PersonTrack& person, ClipFrames frames,
                                    const TrackSettings& request, const SceneInputs& scene);

}  // namespace bodyloom
