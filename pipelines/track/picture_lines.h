// SPDX-License-Identifier: Apache-2.0
/// The vertical from straight lines of the video or photo that a job tracks people in (tracking/room/
/// picture_vertical.h): of a camera that stands still in the clip's median picture, of one whose path is known in the
/// frames that were kept, turned into its scene. The reason why none was found is in its `why`.
#pragma once

#include "geometry/scene/observations.h"
#include "pipelines/detect/detect_people.h"
#include "pipelines/track/scene_inputs.h"
#include "pipelines/track/track_request.h"
#include "tracking/problem/track_input.h"
#include "tracking/room/picture_vertical.h"

namespace bodyloom {

/// From the frames that the detector kept (DetectPeopleRequest::keep_samples): people are masked by their masks, or by
/// the rectangles of their landmarks. `scene`: its camera has the image size.
PictureVertical VerticalOfClip(const TrackSettings& request, const DetectedClip& clip, const SceneInputs& scene);

/// From the request's video, read once more, at most its first minute at 30 frames a second. `keypoints`, in the
/// camera's pixels: of the person, whose rectangle is masked in the frames of their times; null: nobody is masked.
PictureVertical VerticalOfVideo(const TrackRequest& request, const KeypointSequence* keypoints,
                                const SceneInputs& scene);

/// Sets `input`'s vertical, and joins a focal length that is not known with that of the lines. `lines` is borrowed.
void UsePictureVertical(const PictureVertical& lines, CameraKnowledge knowledge, TrackSequenceInput* input);

}  // namespace bodyloom
