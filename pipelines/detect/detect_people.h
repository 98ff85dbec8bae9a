// SPDX-License-Identifier: Apache-2.0
/// Everybody in a video, in memory: frames are decoded by one thread while people are detected by others.
#pragma once

#include <string>
#include <vector>

#include "bodyloom/data_tools/detection/frame_detector.h"
#include "bodyloom/data_tools/observations/people.h"
#include "bodyloom/geometry/observations.h"
#include "bodyloom/pipelines/callbacks.h"
#include "bodyloom/pipelines/detect/frame_source.h"

namespace bodyloom {

struct DetectPeopleRequest {
  std::string video;  ///< the video, or a folder of images
  FrameSpan span;
  FrameDetectorOptions detector;
  /// Frames a second that are detected while everybody moves slowly; those between are filled in (FillBetween()), without
  /// masks. 0: all.
  double detect_rate = 0;
};

struct DetectedClip {
  PeopleSequence people;                         ///< the detector's convention; identities −1
  std::vector<std::vector<PackedLabels>> masks;  ///< [frame][person as in people.frames]; empty unless asked for
  PeopleDetectorSummary detector;
};

/// Throws RequestError when the ONNX files of a detector contradict each other or are not there.
void RequirePoseModels(const FrameDetectorOptions& detector);

/// Throws std::runtime_error naming a file that cannot be used, RequestError for a span that holds no frame, Cancelled.
DetectedClip DetectPeople(const DetectPeopleRequest& request, const PipelineCallbacks& callbacks = {});

/// One of the clip's people (PersonOf()) as a mask; frames without that person are empty. Throws std::invalid_argument
/// when the clip has no masks.
PartLabelSequence MaskOfPerson(const DetectedClip& clip, const PersonTrack& person);

}  // namespace bodyloom
