// SPDX-License-Identifier: Apache-2.0
#include "apps/shown_motion_options.h"

#include <CLI/CLI.hpp>

namespace bodyloom {

void AddViewYaw(CLI::App* verb, std::string* view_yaw) {
  verb->add_option("--view-yaw", *view_yaw,
                   "Turns the view about the person's vertical, degrees; FROM:TO turns it over the clip");
}

void AddShownMotion(CLI::App* verb, const ShownMotion& shown) {
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

}  // namespace bodyloom
