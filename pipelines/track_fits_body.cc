// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/track_fits_body.h"

#include <stdexcept>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

void RequireTrackFitsBody(const Track& track, const BodyModel& body, const std::string& where) {
  if (track.motion.poses.cols() <= 3 * body.num_joints()) return;
  throw std::runtime_error(Concatenate(where, ": ", track.motion.poses.cols() / 3, " joints (body '", track.motion.body,
                                       "'), the body '", body.name(), "' has ", body.num_joints(),
                                       "; give the track's own with --body"));
}

}  // namespace bodyloom
