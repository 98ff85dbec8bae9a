// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "apps/neural/animate_options.h"
#include "apps/neural/neural_verbs.h"
#include "apps/neural/score_options.h"
#include "apps/neural/training_report.h"
#include "apps/progress.h"

namespace bodyloom {
namespace {

struct AnimateGuidedArguments {
  AnimateGuidedRequest request;
  ScorePeopleRequest score;
  std::string background = "photo";
  bool as_seen = false, virtual_views = false;
};

void Run(AnimateGuidedArguments options) {
  AnimateGuidedRequest& request = options.request;
  const bool scored = IsScored(options.score, request);
  request.background = ParsePhotoBackground(options.background);
  if (options.as_seen) request.completion = MapCompletion::kNone;
  if (options.virtual_views) request.completion = MapCompletion::kVirtualViews;
  if (!scored) {
    request.weights = options.score.weights;
    Print(RunWithBar("animate", AnimateGuided, request), request);
    return;
  }
  TakeFrom(request, &options.score);
  options.score.renderer = PeopleRenderer::kGuided;
  options.score.completion = request.completion, options.score.anywhere = request.anywhere;
  Print(RunWithBar("scores", ScorePeople, options.score));
}

}  // namespace

void AddAnimateGuided(CLI::App& animate, Action* action) {
  CLI::App* verb =
      animate.add_subcommand("guided", "Animates the person of a photo, as `bodyloom train guided` learned to");
  auto options = std::make_shared<AnimateGuidedArguments>();
  AnimateGuidedRequest& request = options->request;
  verb->add_option("--run", request.run, "Folder of the trained run")->required();
  verb->add_option("--image", request.photo.image,
                   "The photo: a picture, a video, a folder of pictures, or a single-person dataset");
  verb->add_option("--image-track", request.photo.track, "Its track, .npz (default: the single-person dataset's own)");
  verb->add_option("--image-frame", request.photo.frame, "Frame of a video or dataset that is the photo")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  verb->add_option("--image-labels", request.photo.labels, "DensePose's parts of the photo's clip (.npz)");
  AddPhotoOptions(verb, &request);
  verb->add_option("--track", request.track, "The motion: a track, .npz");
  verb->add_option("--data", request.data,
                   "Instead: a dataset of the same person, whose motion is shown and whose pictures are compared");
  verb->add_option("--out", request.out, "The video, .mp4");
  verb->add_option("--body", request.photo.body, "The tracks' body (default: the built-in body)");
  verb->add_option("--background", options->background, kPhotoBackgroundHelp)->capture_default_str();
  verb->add_flag("--as-seen", options->as_seen, "Leave empty what the photos do not show (the paper's -A)");
  verb->add_flag(
          "--virtual-views", options->virtual_views,
          "Complete the maps over six views drawn by the networks, as the paper does, instead of as the run says")
      ->excludes("--as-seen");
  verb->add_flag(
      "--whole-window", request.anywhere,
      "Compute the whole window: the person may be farther from the body than clothes ever were in training");
  verb->add_flag("--full-size", request.full_size, kFullSizeHelp);
  verb->add_option("--sheet", request.sheet, "Contact sheet: photo, what is known, labels, result");
  verb->add_option("--uv-maps", request.uv_maps, "Picture of the coherent maps and the virtual views");
  verb->add_option("--json", request.json, "Report with times");
  AddScoreOptions(verb, &options->score);
  AddDeviceOptions(verb, &request);
  verb->footer(
      "Example:\n"
      "  bodyloom animate guided --run run --image photo.jpg --image-track photo.npz --track dance.npz --out "
      "dance.mp4");
  verb->callback([options, action] { *action = [options] { Run(*options); }; });
}

}  // namespace bodyloom
