// SPDX-License-Identifier: Apache-2.0
/// Options of `bodyloom animate …` that define how a motion is shown.
#pragma once

#include <string>

#include "geometry/uv_maps/descriptor_options.h"

namespace CLI {
class App;
}

namespace bodyloom {

/// Adds --view-yaw.
void AddViewYaw(CLI::App* verb, std::string* view_yaw);

/// Targets of the options for a trained person.
struct ShownMotionArguments {
  std::string *view_yaw, *freeze, *background;
  bool* shape_of_track;
};

/// Adds --view-yaw, --shape, --freeze, --background.
void AddShownMotion(CLI::App* verb, const ShownMotionArguments& shown);

}  // namespace bodyloom

namespace CLI {
class App;
}

namespace bodyloom {

/// Adds --velocity, --window, --longest-step, --frame, --cameras, --view: axes and velocities of the surface's motion.
void AddSurfaceMotionOptions(CLI::App* verb, SurfaceMotion* motion, std::string* cameras, std::string* view);

}  // namespace bodyloom
