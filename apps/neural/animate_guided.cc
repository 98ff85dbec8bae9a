// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <memory>

#include "apps/neural/animate_from_photo.h"
#include "apps/neural/neural_verbs.h"

namespace bodyloom {

void AddAnimateGuided(CLI::App& animate, Action* action) {
  CLI::App* verb =
      animate.add_subcommand("guided", "Animates the person of a photo, as `bodyloom train guided` learned to");
  auto options = std::make_shared<AnimateFromPhotoArguments>();
  AnimateFromPhotoRequest& request = options->request;
  request.renderer = PersonRendererKind::kGuided;
  AddAnimateFromPhoto(verb, options.get());
  verb->add_option("--data", request.data,
                   "Instead: a dataset of the same person, whose motion is shown and whose images are compared");
  const auto completes = [&request](MapCompletion completion) {
    return [&request, completion](int64_t) { request.completion = completion; };
  };
  verb->add_flag_function("--as-seen", completes(MapCompletion::kNone),
                          "Leave empty what the photos do not show (the paper's -A)");
  verb->add_flag_function(
          "--virtual-views", completes(MapCompletion::kVirtualViews),
          "Complete the maps over six views drawn by the networks, as the paper does, instead of as the run says")
      ->excludes("--as-seen");
  verb->add_flag(
      "--whole-window", request.whole_window,
      "Compute the whole window: the person may be farther from the body than clothes ever were in training");
  verb->add_option("--sheet", request.sheet, "Contact sheet: photo, what is known, labels, result");
  verb->add_option("--uv-maps", request.surface, "Image of the coherent maps and the virtual views");
  verb->footer(
      "Example:\n"
      "  bodyloom animate guided --run run --image photo.jpg --image-track photo.npz --track dance.npz --out "
      "dance.mp4");
  verb->callback([options, action] { *action = [options] { RunAnimateFromPhoto(*options); }; });
}

}  // namespace bodyloom
