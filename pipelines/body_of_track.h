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

/// The same of something learned on a body of so many joints, which a track moves.
std::shared_ptr<const BodyModel> BodyOfJoints(const std::string& path, int num_joints);

/// The track as `body` takes it: on a body of 24 joints a track of the built-in body with fingers loses them, and hand
/// joints rest. Any other track stays as it is.
Track TrackOnBody(const BodyModel& body, Track track);

}  // namespace bodyloom
