// SPDX-License-Identifier: Apache-2.0
/// People detected in a video, as observations for the tracker: in the pixels of its camera.
#pragma once

#include <optional>
#include <utility>

#include "data_tools/observations/load_cameras.h"
#include "data_tools/observations/people.h"
#include "geometry/base/callbacks.h"
#include "geometry/scene/observations.h"
#include "pipelines/detect/detect_people.h"
#include "pipelines/track/scene_inputs.h"
#include "pipelines/track/track_request.h"

namespace bodyloom {

/// What one person showed.
struct DetectedObservations {
  KeypointSequence keypoints;
  std::optional<PartLabelSequence> mask;  ///< none when the request uses no masks
};

/// First and last frame, both included.
using ClipFrames = std::pair<int, int>;
ClipFrames WholeClip(const DetectedClip& clip);
/// From the person's first detection to the last.
ClipFrames SpanOf(const PersonTrack& person);

/// What the request's fields say of detection; at most `max_people` at a time (0: everybody).
DetectPeopleRequest DetectionOf(const TrackSettings& request, int max_people = 0);

/// DetectPeople() by DetectionOf().
DetectedClip DetectForTracking(const TrackSettings& request, const PipelineCallbacks& callbacks, int max_people = 0);

/// The person's landmarks and mask in those frames; where it was not seen they are missing. Landmarks whose confidence
/// is below request.min_confidence are missing too. Throws std::runtime_error when the scene's camera is for images of
/// other proportions than the video's.
DetectedObservations ObservationsOf(const DetectedClip& clip, const PersonTrack& person, ClipFrames frames,
                                    const TrackSettings& request, const SceneInputs& scene);

// Observations made in a video's pixels, moved into those of the camera that its calibration describes.

/// Keypoints at p become those at q with p = video_from_camera · (q, 1). The image size becomes the camera's.
KeypointSequence MovedToCamera(KeypointSequence keypoints, const Matrix2x3d& video_from_camera, int camera_width,
                               int camera_height);

/// Labels: each pixel of the camera's image takes the label of the video's pixel next to its place.
PartLabelSequence MovedToCamera(const PartLabelSequence& labels, const Matrix2x3d& video_from_camera, int camera_width,
                                int camera_height);

}  // namespace bodyloom
