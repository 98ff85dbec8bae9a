// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "apps/command_callbacks.h"
#include "apps/neural/animate_options.h"
#include "apps/neural/guided_report.h"
#include "apps/neural/neural_verbs.h"

namespace bodyloom {
namespace {

struct AnimateGuidedArguments {
  AnimateGuidedRequest request;
  std::string background = "photo", score;
  std::vector<int> score_photos = {1};
  int score_frames = 8;
  bool as_seen = false, virtual_views = false;
};

ScoreGuidedSummary Score(const AnimateGuidedArguments& options) {
  const AnimateGuidedRequest& a = options.request;
  ScoreGuidedRequest request;
  request.run = a.run, request.data = options.score, request.body = a.photo.body;
  request.photos = options.score_photos, request.frames = options.score_frames;
  request.completion = a.completion, request.anywhere = a.anywhere;
  request.sheet = a.sheet, request.json = a.json, request.weights = a.weights;
  request.threads = a.threads, request.device = a.device;
  return RunWithBar("scores", ScoreGuided, request);
}

void Run(AnimateGuidedArguments options) {
  AnimateGuidedRequest& request = options.request;
  if (options.score.empty() && (request.photo.image.empty() || request.out.empty())) {
    throw RequestError("--image and --out are needed (or --score, to measure on a multi-person dataset)");
  }
  if (!options.score.empty() &&
      (request.shape_of_motion || !request.view_yaw.empty() || !request.garment.from.empty())) {
    throw RequestError("--score measures people as they are: not with --shape, --view-yaw or --garment-from");
  }
  request.background = ParsePhotoBackground(options.background);
  if (options.as_seen) request.completion = MapCompletion::kNone;
  if (options.virtual_views) request.completion = MapCompletion::kVirtualViews;
  if (options.score.empty()) {
    Print(RunWithBar("animate", AnimateGuided, request), request);
  } else {
    Print(Score(options));
  }
}

}  // namespace

void AddAnimateGuided(CLI::App& animate, Action* action) {
  CLI::App* verb =
      animate.add_subcommand("animate", "Animates the person of a photo, as `bodyloom train animate` learned to");
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
      "--anywhere", request.anywhere,
      "Compute the whole window: the person may be farther from the body than clothes ever were in training");
  verb->add_flag("--full-size", request.full_size, kFullSizeHelp);
  verb->add_option("--sheet", request.sheet, "Contact sheet: photo, what is known, labels, result");
  verb->add_option("--uv-maps", request.uv_maps, "Picture of the coherent maps and the virtual views");
  verb->add_option("--json", request.json, "Report with times");
  verb->add_option("--score", options->score, "Instead: measure on the test people of this multi-person dataset");
  verb->add_option("--score-photos", options->score_photos, "Numbers of photos to measure with, such as 1 2 4")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  verb->add_option("--score-frames", options->score_frames, "Pictures of each person to compare with")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  AddLikenessWeights(verb, &request.weights, "alexnet and lpips_alex for LPIPS, vgg19 for contextual scores");
  AddDeviceOptions(verb, &request);
  verb->footer(
      "Example:\n"
      "  bodyloom animate animate --run run --image photo.jpg --image-track photo.npz --track dance.npz --out "
      "dance.mp4");
  verb->callback([options, action] { *action = [options] { Run(*options); }; });
}

}  // namespace bodyloom
