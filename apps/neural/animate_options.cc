// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/animate_options.h"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "apps/shown_motion_options.h"

namespace bodyloom {

PhotoBackground ParsePhotoBackground(const std::string& option) {
  PhotoBackground result;
  result.own = option == "photo";
  if (!result.own && option != "studio") result.path = option;
  return result;
}

void AddPhotoOptions(CLI::App* verb, PhotoAnimationRequest* request) {
  verb->add_option("--views", request->views,
                   "More pictures of the person, IMAGE:TRACK[:FRAME]: what they show is added");
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
                   "The same of the motion's pictures, a folder of IUV images: not with --view-yaw");
}

void AddLikenessWeights(CLI::App* verb, std::string* weights, const char* what) {
  verb->add_option("--weights", *weights,
                   std::string("Folder with trained weights (.safetensors, .pth): ") + what +
                       "; without them random features measure, which compare with nothing else")
      ->type_name("DIR");
}

void AddDeviceOptions(CLI::App* verb, AnimationRequest* request) {
  verb->add_option("--threads", request->threads, "0: all cores")->check(CLI::NonNegativeNumber);
  verb->add_option("--device", request->device, "Where the networks run")
      ->check(CLI::IsMember({"cpu", "cuda"}))
      ->capture_default_str();
}

void PrintFramesWithoutFit(const AnimationSummary& summary) {
  if (summary.frames_without_fit > 0) {
    std::printf("%d frames have no fit and show the background\n", summary.frames_without_fit);
  }
}

}  // namespace bodyloom
