// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bodyloom/data_tools/descriptors/surface_motion.h"

namespace bodyloom {

/// The camera's pose for SurfaceFrame::kWorld: that of `view` in the camera file; without one that of the world of
/// the file `track` (geometry/world_frame.h), or a level camera when it does not say or there is none. Other axes need none. Throws RequestError for a camera file with other axes, std::runtime_error for one that cannot be
/// used.
void SetAxesPose(const std::string& cameras, const std::string& view, const std::string& track, SurfaceMotion* motion);

}  // namespace bodyloom
