// SPDX-License-Identifier: Apache-2.0
/// Finds the turn of a video whose camera lay on its side or hung upside down.
#pragma once

#include "geometry/base/callbacks.h"
#include "pipelines/detect/detect_people.h"

namespace bodyloom {

/// The clockwise turn of the video's frames, 0, 90, 180 or 270 degrees, after which the detector finds most people with
/// their shoulders above their hips (within 45 degrees), weighted by the landmarks' confidence, in up to 12 frames
/// spread over the span. The frames stay as they are unless another turn has half as much again, and if nobody is
/// found. A person who lies in a level picture is taken for one who stands in a turned one. The result is reported by
/// callbacks.Message(); request.span.turn_deg is not used. Throws as DetectPeople().
int FindTurn(const DetectPeopleRequest& request, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
