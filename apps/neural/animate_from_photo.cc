// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/animate_from_photo.h"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "apps/neural/animate_options.h"
#include "apps/neural/score_options.h"
#include "apps/progress.h"
#include "apps/shown_motion_options.h"
#include "apps/usage_error.h"

namespace bodyloom {
namespace {

constexpr const char* kPhotoBackgroundHelp =
    "Behind the person: photo (the photo's own, filled in), studio (a plain backdrop), or an image, video or folder";

/// Of --background.
PhotoBackground ParsePhotoBackground(const std::string& option) {
  PhotoBackground result;
  result.own = option == "photo";
  if (!result.own && option != "studio") result.path = option;
  return result;
}

/// Adds the options of appearance, view and body shape.
void AddPhotoOptions(CLI::App* verb, PhotoAnimationRequest* request) {
  verb->add_option("--views", request->views,
                   "More images of the person, IMAGE:TRACK[:FRAME]: what they show is added");
  verb->add_option("--garment-from", request->garment.from, "Another person, IMAGE:TRACK[:FRAME], who lends --parts");
  verb->add_option("--parts", request->garment.parts, "top, bottom, shoes, head, arms, or DensePose parts 1 to 24")
      ->delimiter(',');
  verb->add_option_function<std::string>(
          "--shape", [request](const std::string& whose) { request->shape_of_motion = whose == "motion"; },
          "Whose body shape moves: the photo's or the motion's")
      ->check(CLI::IsMember({"photo", "motion"}))
      ->default_str("photo");
  AddViewYaw(verb, &request->view_yaw);
  verb->add_option(
      "--image-iuv", request->photo.iuv,
      "What the photo's pixels show of the body, by an estimate from it: DensePose's IUV image, or a folder "
      "of one a frame (default: the tracked body)");
  verb->add_option("--iuv", request->iuv,
                   "The same of the motion's images, a folder of IUV images: not with --view-yaw");
}

void Print(const AnimateFromPhotoSummary& s, const AnimateFromPhotoRequest& request) {
  std::printf("%d frames, %.0f %% of the texture seen, source encoded in %.1f s, networks %.0f ms a frame", s.frames,
              100 * s.texels_seen, s.source_seconds, s.network_ms);
  if (s.computed_share) std::printf(" (%.0f %% of the window)", 100 * *s.computed_share);
  std::printf(", %.1f frames/s rendered and written\n", s.FramesPerSecond());
  PrintFramesWithoutFit(s);
  if (s.frames_kept > 0) {
    std::printf("%lld frames were those before and were not computed again\n", static_cast<long long>(s.frames_kept));
  }
  if (s.scores) std::printf("against %s: %s\n", request.data.c_str(), ScoresText(*s.scores).c_str());
  std::printf("wrote %s\n", request.out.c_str());
}

}  // namespace

void RunAnimateFromPhoto(AnimateFromPhotoArguments options) {
  AnimateFromPhotoRequest& request = options.request;
  const bool scored = IsScored(options.score, request), guided = request.renderer == PersonRendererKind::kGuided;
  request.background = ParsePhotoBackground(options.background);
  if (scored) {
    TakeFrom(request, &options.score);
    options.score.renderer = guided ? PeopleRenderer::kGuided : PeopleRenderer::kPhoto;
    options.score.completion = request.completion, options.score.whole_window = request.whole_window;
    Print(RunWithBar("scores", ScorePeople, options.score));
    return;
  }
  if (!guided && request.track.empty()) throw RequestError("--track is needed: the motion");
  if (!guided && !options.score.weights.empty()) throw RequestError("--weights measure the images of --score");
  request.weights = options.score.weights;
  Print(RunWithBar("animate", AnimateFromPhoto, request), request);
}

void AddAnimateFromPhoto(CLI::App* verb, AnimateFromPhotoArguments* options) {
  AnimateFromPhotoRequest& request = options->request;
  verb->add_option("--run", request.run, "Folder of the trained run")->required();
  verb->add_option("--image", request.photo.image,
                   "The photo: an image, a video, a folder of images, or a single-person dataset");
  verb->add_option("--image-track", request.photo.track, "Its track, .npz (default: the single-person dataset's own)");
  verb->add_option("--image-frame", request.photo.frame, "Frame of a video or dataset that is the photo")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  verb->add_option("--image-labels", request.photo.labels,
                   "DensePose's parts of the photo's clip (.npz), which give the silhouette (default: GrabCut)");
  AddPhotoOptions(verb, &request);
  verb->add_option("--track", request.track, "The motion: a track, .npz");
  verb->add_option("--out", request.out, "The video, .mp4");
  verb->add_option("--body", request.photo.body, BodyHelp("The tracks' body"));
  verb->add_option("--background", options->background, kPhotoBackgroundHelp)->capture_default_str();
  verb->add_flag("--full-size", request.full_size, kFullSizeHelp);
  verb->add_option("--json", request.json, "Report with times");
  AddScoreOptions(verb, &options->score);
  AddDeviceOptions(verb, &request);
}

}  // namespace bodyloom
