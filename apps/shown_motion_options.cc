// SPDX-License-Identifier: Apache-2.0
#include "apps/shown_motion_options.h"

#include <CLI/CLI.hpp>

namespace bodyloom {

void AddViewYaw(CLI::App* verb, std::string* view_yaw) {
  verb->add_option("--view-yaw", *view_yaw,
                   "Turns the view about the person's vertical, degrees; FROM:TO turns it over the clip");
}

void AddShownMotion(CLI::App* verb, const ShownMotionArguments& shown) {
  AddViewYaw(verb, shown.view_yaw);
  verb->add_option_function<std::string>(
          "--shape", [of_track = shown.shape_of_track](const std::string& whose) { *of_track = whose == "track"; },
          "Whose body moves: run (the person who was trained on, as motion transfer means it), or track")
      ->check(CLI::IsMember({"run", "track"}))
      ->default_str("run");
  verb->add_option(
      "--freeze", *shown.freeze,
      "FRAME:COUNT: time stands still at that frame for so many more, while --view-yaw FROM:TO turns the view");
  verb->add_option("--background", *shown.background, "Image, video or folder of images behind the person");
}

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
