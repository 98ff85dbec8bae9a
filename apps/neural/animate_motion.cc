// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>

#include "apps/neural/animate_options.h"
#include "apps/neural/neural_verbs.h"
#include "apps/progress.h"
#include "apps/shown_motion_options.h"
#include "apps/usage_error.h"
#include "pipelines/animate/motion_errors.h"
#include "pipelines/neural/motion/animate_motion.h"

namespace bodyloom {
namespace {

void PrintScores(const AnimateMotionRequest& request, const ClipScores& scores) {
  std::printf("against %s: %s\n", request.data.c_str(), ScoresText(scores.windows).c_str());
  if (scores.composed) {
    std::printf("over %s: PSNR %.2f dB of the whole image, %.2f dB within %d px of the contour\n",
                request.background.c_str(), scores.composed->psnr_db, scores.composed->rim_psnr_db,
                CompositeScore::kRimPixels);
  }
  for (const MotionErrors::Quarter& quarter : scores.by_similarity) {
    std::printf("  %d frames of similarity %.3f and more: %s\n", quarter.frames, quarter.min_similarity,
                ScoresText(quarter.scores, scores.windows.lpips_random_features).c_str());
  }
}

void Run(AnimateMotionRequest request) {
  request.set_command = CommandLine(request);
  const AnimateMotionSummary summary = RunWithBar("animate", AnimateMotion, request);
  std::printf("%d frames, window %dx%d px of a %dx%d image, network %.0f ms a frame, %.1f frames/s in all\n",
              summary.frames, summary.window_width, summary.window_height, summary.shrunk_width, summary.shrunk_height,
              summary.network_ms, summary.frames / std::max(1e-9, summary.total_seconds));
  PrintFramesWithoutFit(summary);
  if (summary.light && !summary.light->IsUsable()) {
    std::printf("light of the clip not found (%s): taken as even\n", ToString(summary.light->status).c_str());
  }
  if (summary.descriptors_kept > 0) {
    std::printf("%lld frames did not move: their descriptors were not computed again\n",
                static_cast<long long>(summary.descriptors_kept));
  }
  if (summary.scores) PrintScores(request, *summary.scores);
  std::printf("wrote %s\n", request.out.c_str());
}

}  // namespace

void AddAnimateMotion(CLI::App& animate, Action* action) {
  CLI::App* verb =
      animate.add_subcommand("motion", "Renders a person that `bodyloom train motion` learned, in any motion");
  auto request = std::make_shared<AnimateMotionRequest>();
  verb->add_option("--run", request->run, "Folder of the trained run")->required();
  verb->add_option("--track", request->track, "The motion: a track, .npz (default: that of --data)");
  verb->add_option("--data", request->data,
                   "A dataset of the same person: the result is compared with its images (not with --view-yaw, "
                   "--freeze or --speed)");
  verb->add_option("--iuv", request->iuv,
                   "With --data: what its pixels show of the body, a folder of DensePose's IUV images, or \"own\", the "
                   "dataset's (default: the tracked body)");
  verb->add_option("--out", request->out, "The video, .mp4")->required();
  verb->add_option("--body", request->body, BodyHelp("The track's body"));
  verb->add_option("--speed", request->speed, "Plays the motion so many times as fast: clothes move differently")
      ->check(CLI::Range(0.05, 20.0))
      ->capture_default_str();
  AddShownMotion(verb, {&request->view_yaw, &request->freeze, &request->background, &request->shape_of_track});
  CLI::Option* full_size = verb->add_flag("--full-size", request->full_size, kFullSizeHelp);
  verb->add_option("--set", request->set,
                   "Also a single-person dataset: images, labels and normals without loss, for `bodyloom metrics`")
      ->type_name("DIR")
      ->needs(full_size);
  verb->add_option("--relight", request->relight,
                   "Other light: an environment image (equirectangular), or JSON with lights (docs/relighting.md)");
  verb->add_flag("--true-normals", request->true_normals,
                 "With --relight and --data: by the dataset's normals, to see what the predicted ones cost");
  verb->add_option("--warmup", request->warmup, "Passes of the first frame through the network before it counts")
      ->capture_default_str()
      ->check(CLI::Range(0, 1000));
  verb->add_flag("--without-past", request->without_past,
                 "Every frame as if it were the first, warmed up from nothing: what its own motion says, not what the "
                 "renderer's last images do");
  verb->add_flag("--whole-window", request->whole_window,
                 "The person may be farther from the body than clothes ever were in training");
  verb->add_option(
      "--like", request->like,
      "A single-person dataset, or a track: with --data, the error by how much each frame's motion is like one there");
  verb->add_option("--frames", request->frames, "With --data: a line of CSV a frame, error and similarity");
  AddLikenessWeights(verb, &request->weights, "alexnet and lpips_alex, for LPIPS and tLPIPS");
  verb->add_option("--sheet", request->sheet, "Contact sheet of six frames: image, labels, normals");
  verb->add_option("--json", request->json, "Report with times");
  AddDeviceOptions(verb, request.get());
  verb->footer("Example:\n  bodyloom animate motion --run run --track dance.npz --out dance.mp4 --view-yaw 0:360");
  verb->callback([request, action] { *action = [request] { Run(*request); }; });
}

}  // namespace bodyloom
