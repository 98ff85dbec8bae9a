// SPDX-License-Identifier: Apache-2.0
/// Tells from landmarks whether people are upright in a picture, and finds the turn of a video whose camera was not.
#pragma once

#include <string>

#include "data_tools/observations/people.h"
#include "geometry/base/callbacks.h"
#include "pipelines/detect/detect_people.h"

namespace bodyloom {

/// A person's shoulders and hips.
struct Trunk {
  double confidence = 0;    ///< mean of the four landmarks'
  bool is_upright = false;  ///< the shoulders are above the hips, within 45 degrees
};
/// Throws std::invalid_argument for a convention without shoulders or hips.
Trunk TrunkOf(const DetectedPerson& person, const KeypointConvention& convention);

/// Advice to look for the turn of the camera (FindTurn()), a sentence, if at most a quarter of the clip's trunks that
/// are seen with a confidence of at least ½ are upright; else, and without such trunks, empty.
std::string AdviceOnTurn(const PeopleSequence& people);
/// Says it of the people found in `video`, where the caller's user can follow it.
void SayAdviceOnTurn(const std::string& video, const PeopleSequence& people, const PipelineCallbacks& callbacks);

/// Finds the turn of a video whose camera lay on its side or hung upside down.
/// The clockwise turn of the video's frames, 0, 90, 180 or 270 degrees, after which the detector finds most people with
/// their shoulders above their hips (within 45 degrees), weighted by the landmarks' confidence, in up to 12 frames
/// spread over the span. The frames stay as they are unless another turn has half as much again, and if nobody is
/// found. A person who lies in a level picture is taken for one who stands in a turned one. The result is reported by
/// callbacks.Message(); request.span.turn_deg is not used. Throws as DetectPeople().
int FindTurn(const DetectPeopleRequest& request, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
