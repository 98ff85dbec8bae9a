// SPDX-License-Identifier: Apache-2.0
/// The body of a track, for jobs in several folders that read one.
#pragma once

#include <memory>
#include <string>

#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// The body in a file, as BodyOrBuiltin(); for an empty path the built-in body, with fingers if that is the track's.
/// Throws std::runtime_error as BodyOrBuiltin().
std::shared_ptr<const BodyModel> BodyOfTrack(const std::string& path, const Track& track);

}  // namespace bodyloom
