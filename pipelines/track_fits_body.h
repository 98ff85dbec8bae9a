// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/track.h"

namespace bodyloom {

/// Throws std::runtime_error "where: …" when the track's poses have more joints than the body.
void RequireTrackFitsBody(const Track& track, const BodyModel& body, const std::string& where);

}  // namespace bodyloom
