// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "apps/neural/animate_options.h"
#include "apps/neural/neural_verbs.h"
#include "apps/neural/score_options.h"
#include "apps/progress.h"
#include "pipelines/neural/photo/animate_photo.h"

namespace bodyloom {
namespace {

struct AnimatePhotoArguments {
  AnimatePhotoRequest request;
  ScorePeopleRequest score;
  std::string background = "photo";
};

void Run(AnimatePhotoArguments options) {
  AnimatePhotoRequest& request = options.request;
  request.background = ParsePhotoBackground(options.background);
  if (IsScored(options.score, request)) {
    TakeFrom(request, &options.score);
    options.score.renderer = PeopleRenderer::kPhoto;
    options.score.anywhere = request.whole_window;
    Print(RunWithBar("scores", ScorePeople, options.score));
    return;
  }
  if (request.track.empty()) throw RequestError("--track is needed: the motion");
  if (!options.score.weights.empty()) throw RequestError("--weights measure the pictures of --score");
  const AnimatePhotoSummary summary = RunWithBar("animate", AnimatePhoto, request);
  std::printf("%d frames, %.0f %% of the texture seen, network %.0f ms a frame, %.1f frames/s rendered and written\n",
              summary.frames, 100 * summary.texels_seen, summary.network_ms, summary.frames_per_second);
  PrintFramesWithoutFit(summary);
  std::printf("wrote %s\n", request.out.c_str());
}

}  // namespace

void AddAnimatePhoto(CLI::App& animate, Action* action) {
  CLI::App* verb = animate.add_subcommand("photo", "Renders a person from one photo, in any motion");
  auto options = std::make_shared<AnimatePhotoArguments>();
  AnimatePhotoRequest& request = options->request;
  verb->add_option("--run", request.run, "Folder of a run of `bodyloom train photo`")->required();
  verb->add_option("--image", request.photo.image,
                   "The photo: a picture, a video, a folder of pictures, or a single-person dataset");
  verb->add_option("--image-track", request.photo.track, "Its track, .npz (default: the single-person dataset's own)");
  verb->add_option("--image-frame", request.photo.frame, "Which frame of image and track")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  verb->add_option("--image-labels", request.photo.labels,
                   "DensePose's parts of the photo, which give the silhouette (default: GrabCut)");
  verb->add_option("--track", request.track, "The motion: a track, .npz");
  verb->add_option("--out", request.out, "The video, .mp4");
  verb->add_option("--body", request.photo.body, "The tracks' body (default: the built-in body)");
  AddPhotoOptions(verb, &request);
  verb->add_option("--background", options->background, kPhotoBackgroundHelp)->capture_default_str();
  verb->add_flag("--full-size", request.full_size, kFullSizeHelp);
  verb->add_flag("--whole-window", request.whole_window, "Compute the background of the window too");
  verb->add_option("--sheet", request.sheet, "Contact sheet: photo, its texture, the completed one, six frames");
  verb->add_option("--texture", request.texture, "The completed texture as an image");
  verb->add_option("--json", request.json, "Report with times");
  AddScoreOptions(verb, &options->score);
  AddDeviceOptions(verb, &request);
  verb->footer(
      "Example:\n"
      "  bodyloom animate photo --run run --image me.jpg --image-track me.npz --track dance.npz --out me.mp4\n"
      "      --garment-from you.jpg:you.npz --parts top,bottom");
  verb->callback([options, action] { *action = [options] { Run(*options); }; });
}

}  // namespace bodyloom
