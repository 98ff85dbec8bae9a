// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "apps/command_callbacks.h"
#include "apps/detector_options.h"
#include "apps/exit_code.h"
#include "apps/verbs.h"
#include "bodyloom/pipelines/detect/detect_clip.h"

namespace bodyloom {
namespace {

constexpr const char* kFooter =
    "Everybody in the video is found and followed by BlazePose (33 landmarks), on the processor. The networks come "
    "with\n"
    "./dev models, from --models, or from the folder that $BODYLOOM_MODELS names.\n"
    "Examples:\n"
    "  bodyloom detect --video clip.mp4 --out detections.npz --mask mask.npz\n"
    "then\n"
    "  bodyloom track --detections detections.npz --part-labels mask.npz --video clip.mp4 --out track.npz\n\n";

}  // namespace

void AddDetectVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("detect", "Finds the people in a video and their 2D landmarks");
  verb->footer(std::string(kFooter) + kExitCodeHelp);
  auto request = std::make_shared<DetectClipRequest>();
  auto quiet = std::make_shared<bool>(false);
  DetectPeopleRequest& detect = request->detect;
  PeopleDetectorOptions& detector = detect.detector;
  verb->add_option("--video", detect.video, "the video, or a folder of images")->required()->type_name("PATH");
  verb->add_option("--out", request->out, "everybody's landmarks, .npz")->type_name("FILE");
  verb->add_option("--mask", request->mask, "the mask of one person, .npz")->type_name("FILE");
  verb->add_option("--person", request->person, "whose mask: 0 is the largest and longest in view")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--people", detector.max_people, "follow at most so many people at a time (0: everybody)")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  AddDetectorOptions(*verb, &detector.network, &detect.models, "Options");
  verb->add_option("--from", detect.from_s, "begin at this second")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--to", detect.to_s, "end with this second (default: the end)")->check(CLI::NonNegativeNumber);
  verb->add_option("--fps", detect.fps, "frame rate of a folder of images (default 30)")->check(CLI::PositiveNumber);
  verb->add_option("--search-interval", detector.search_interval, "frames between searches for new people")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  verb->add_option("--tiles", detector.tile_levels,
                   "search squares of down to 1/N of the longer side: finds people from about 0.28/N of it")
      ->capture_default_str()
      ->check(CLI::Range(1, 8));
  verb->add_option("--json", request->json, "who was found, and times")->type_name("FILE");
  verb->add_flag("--quiet", *quiet, "print nothing but errors");
  verb->callback([request, quiet, action] {
    *action = [request, quiet] {
      const DetectClipReport report = DetectClip(*request, CommandCallbacks(*quiet));
      if (!*quiet) std::cout << ToText(report);
    };
  });
}

}  // namespace bodyloom
