// SPDX-License-Identifier: Apache-2.0
/// Exports the joint angles of a track, and the events of gait.
#pragma once

#include <string>

#include "geometry/biomechanics/gait.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"
#include "geometry/scene/world_frame.h"

namespace bodyloom {

/// "angles are written to .csv or .mot (OpenSim), found …" for a path of another extension; "" for these.
std::string AnglesPathFault(const std::string& out);

/// Writes the angles as CSV (the pelvis' rotation first) or, to a path that ends in .mot, for OpenSim (its tilt first,
/// data_tools/export/angle_writers.h), the gait as JSON to `events` if that is not empty, and returns the gait. Throws
/// std::invalid_argument for a body without the joints, and of .mot when every frame is lost.
GaitReport ExportAngles(const BodyModel& body, const Track& track, const WorldFrame& world, const std::string& out,
                        const std::string& events);

}  // namespace bodyloom
