// SPDX-License-Identifier: Apache-2.0
#include "apps/surface_motion_options.h"

#include <CLI/CLI.hpp>

namespace bodyloom {

void AddSurfaceMotionOptions(CLI::App* verb, SurfaceMotion* motion, std::string* cameras, std::string* view) {
  verb->add_option_function<std::string>(
          "--velocity", [motion](const std::string& name) { SetVelocity(name, motion); },
          "backward, central, savgol or analytic")
      ->default_str(VelocityName(*motion))
      ->check(CLI::IsMember(VelocityNames()))
      ->type_name("SCHEME");
  verb->add_option("--window", motion->velocity.window_s, "savgol and analytic: time the fit spans, s")
      ->capture_default_str();
  verb->add_option("--longest-step", motion->velocity.longest_step_s,
                   "a longer step between frames is a gap, s (default: 1.5 times the median)");
  verb->add_option_function<std::string>(
          "--frame", [motion](const std::string& name) { motion->frame = SurfaceFrameNamed(name); },
          "axes of normals and velocities: camera, world or body")
      ->default_str(ToString(motion->frame))
      ->check(CLI::IsMember(SurfaceFrameNames()))
      ->type_name("FRAME");
  verb->add_option("--cameras", *cameras, "camera file with the pose for --frame world")->type_name("FILE");
  verb->add_option("--view", *view, "the camera's name in it")->type_name("NAME");
}

}  // namespace bodyloom
