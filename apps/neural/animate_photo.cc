// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <memory>

#include "apps/neural/animate_from_photo.h"
#include "apps/neural/neural_verbs.h"

namespace bodyloom {

void AddAnimatePhoto(CLI::App& animate, Action* action) {
  CLI::App* verb = animate.add_subcommand("photo", "Renders a person from one photo, in any motion");
  auto options = std::make_shared<AnimateFromPhotoArguments>();
  AnimateFromPhotoRequest& request = options->request;
  AddAnimateFromPhoto(verb, options.get());
  verb->add_flag("--whole-window", request.whole_window, "Compute the background of the window too");
  verb->add_option("--sheet", request.sheet, "Contact sheet: photo, its texture, the completed one, six frames");
  verb->add_option("--texture", request.surface, "The completed texture as an image");
  verb->footer(
      "Example:\n"
      "  bodyloom animate photo --run run --image me.jpg --image-track me.npz --track dance.npz --out me.mp4\n"
      "      --garment-from you.jpg:you.npz --parts top,bottom");
  verb->callback([options, action] { *action = [options] { RunAnimateFromPhoto(*options); }; });
}

}  // namespace bodyloom
