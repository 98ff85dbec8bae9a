// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bodyloom/data_tools/descriptors/surface_motion.h"

namespace CLI {
class App;
}

namespace bodyloom {

/// --velocity, --window, --longest-step, --frame, --cameras, --view: the axes and velocities of a surface's motion.
void AddSurfaceMotionOptions(CLI::App* verb, SurfaceMotion* motion, std::string* cameras, std::string* view);

}  // namespace bodyloom
