// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <memory>

#include "apps/progress.h"
#include "apps/shown_motion_options.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"
#include "pipelines/gaussian_avatar/animate_avatar.h"

namespace bodyloom {
namespace {

void RunAnimateAvatar(const AnimateAvatarRequest& request) {
  const AnimateAvatarSummary summary = RunWithBar("animate", AnimateAvatar, request);
  std::printf("%d frames of %dx%d px, %d Gaussians, %.1f ms a frame to pose and draw (%.0f px), %.1f frames/s in all\n",
              summary.frames, summary.width, summary.height, summary.gaussians, summary.draw_ms, summary.pixels,
              summary.frames / (summary.total_seconds > 0 ? summary.total_seconds : 1));
  if (summary.frames_without_fit > 0) {
    std::printf("%d frames have no fit and show the background\n", summary.frames_without_fit);
  }
  if (summary.scores) std::cout << "against " << request.data << ", " << ScoresText(*summary.scores) << "\n";
  for (const std::string& path : summary.written) std::cout << "wrote " << path << "\n";
}

}  // namespace

void AddAnimateAvatar(CLI::App& animate, Action* action) {
  CLI::App* verb =
      animate.add_subcommand("avatar", "Renders a person that `bodyloom train avatar` learned, in any motion");
  auto request = std::make_shared<AnimateAvatarRequest>();
  verb->add_option("--run", request->run, "Folder of the trained run, or its avatar.npz")->required();
  verb->add_option("--track", request->track, "The motion: a track, .npz (default: that of --data)");
  verb->add_option("--data", request->data,
                   "Images to compare with: a single-person dataset, or a video with --track and --mask");
  verb->add_option("--mask", request->mask, "The person's mask in the video of --data");
  verb->add_option("--out", request->out, "The video, .mp4");
  verb->add_option("--pictures", request->pictures, "A folder for PNGs of the person with transparency")
      ->type_name("DIR");
  verb->add_option("--set", request->set,
                   "A single-person dataset of the images, with the garment's pixels, for `bodyloom metrics`")
      ->type_name("DIR");
  verb->add_option("--body", request->body, BodyHelp("The track's body"));
  AddShownMotion(verb, {&request->view_yaw, &request->freeze, &request->background, &request->shape_of_track});
  verb->add_option("--size", request->size, "Pixels of the image's longer side (default: as the track's)")
      ->check(CLI::Range(2, 8192));
  verb->add_option("--ply", request->ply, "The Gaussians at rest, for viewers of 3D Gaussian Splatting, .ply");
  CLI::Option* posed = verb->add_option("--posed-ply", request->posed_ply, "The Gaussians of --ply-frame, posed, .ply");
  verb->add_option("--ply-frame", request->posed_frame, "Frame of --posed-ply")->capture_default_str()->needs(posed);
  verb->add_option("--report", request->report, "One HTML file in which the person moves and is turned by hand");
  verb->add_option("--json", request->json, "Report with times and scores");
  verb->add_option("--threads", request->threads, "0: all cores")->check(CLI::Range(0, 1024));
  verb->footer(
      "Needs no LibTorch.\n"
      "Example:\n"
      "  bodyloom animate avatar --run run --track dance.npz --view-yaw 0:360 --background b.jpg --out dance.mp4");
  verb->callback([request, action] { *action = [request] { RunAnimateAvatar(*request); }; });
}

}  // namespace bodyloom
