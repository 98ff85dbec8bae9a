// SPDX-License-Identifier: Apache-2.0
/// Options of `bodyloom animate …` that say how a motion is shown.
#pragma once

#include <string>

#include "geometry/uv_maps/descriptor_options.h"

namespace CLI {
class App;
}

namespace bodyloom {

/// --view-yaw.
void AddViewYaw(CLI::App* verb, std::string* view_yaw);

/// Where the options of a person who was trained on go.
struct ShownMotionArguments {
  std::string *view_yaw, *freeze, *background;
  bool* shape_of_track;
};

/// --view-yaw, --shape, --freeze, --background.
void AddShownMotion(CLI::App* verb, const ShownMotionArguments& shown);

}  // namespace bodyloom

namespace CLI {
class App;
}

namespace bodyloom {

/// --velocity, --window, --longest-step, --frame, --cameras, --view: the axes and velocities of a surface's motion.
void AddSurfaceMotionOptions(CLI::App* verb, SurfaceMotion* motion, std::string* cameras, std::string* view);

}  // namespace bodyloom
