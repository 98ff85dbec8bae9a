// SPDX-License-Identifier: Apache-2.0
/// A motion that is known in closed form, for benchmarks of what comes after tracking.
#pragma once

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/posed_body.h"
#include "bodyloom/geometry/track.h"

namespace bodyloom {

/// Every joint swings at its own phase, the body walks and turns: smooth, at most `hz`.
BodyPose PoseAt(const BodyModel& body, double time, double hz);

/// T frames of it before a camera of 640×640, with noise on every joint's rotation (`noise`, radians) and on the place.
Track TrackOf(const BodyModel& body, int T, double fps, double hz, double noise);

}  // namespace bodyloom
