// SPDX-License-Identifier: Apache-2.0
/// Tells from landmarks whether people are upright in a picture.
#pragma once

#include <string>

#include "data_tools/observations/people.h"
#include "geometry/base/callbacks.h"

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

}  // namespace bodyloom
